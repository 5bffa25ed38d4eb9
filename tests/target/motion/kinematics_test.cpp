#include "target/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "machine.h"

namespace lyr::motion {
namespace {

double value(const Linear& motor, double distance_mm) {
    return motor.start + motor.rate * distance_mm;
}

double value(const Harmonic& motor, double distance_mm) {
    CHECK(motor.amplitude > 0);
    CHECK(motor.rate > 0);
    CHECK(motor.phase_rad >= 0);
    CHECK(motor.phase_rad <= 6.2831853071795865);
    return motor.start + motor.amplitude * (std::cos(motor.phase_rad + motor.rate * distance_mm) -
                                            std::cos(motor.phase_rad));
}

}  // namespace

TEST_CASE("kinematics 1, 2, 3: a Cartesian motor follows its axis") {
    std::mt19937 random(21);
    const Cartesian cartesian{{80, -160, 400, -415}};
    const Point origin{3, -2, 0.5};
    for (const Move& move : test::random_moves(random, 300, 5, origin, true)) {
        const MotorPaths motors = motor_paths(cartesian, move.path, origin);
        const double length_mm = length_of(move.path);
        for (const double share : {0.0, 0.3, 0.71, 1.0}) {
            const Point at = point_at(move.path, share * length_mm);
            const std::array<double, motor_count> expected{
                80 * (at.x - origin.x), -160 * (at.y - origin.y), 400 * (at.z - origin.z),
                -415 * share * advance_of(move.path)};
            for (std::size_t motor = 0; motor < motor_count; ++motor) {
                const double steps =
                    std::visit([&](const auto& path) { return value(path, share * length_mm); },
                               motors[motor]);
                CHECK(std::abs(steps - expected[motor]) < 1e-8);
            }
        }
    }
}

TEST_CASE("kinematics: steps per mm that are no number or absurd are named") {
    CHECK(check(Cartesian{{80, -80, 0, 1e6}}).ok());
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 2e6, -2e6})
        for (std::size_t axis = 0; axis < axis_count; ++axis) {
            Cartesian cartesian{{80, 80, 80, 80}};
            cartesian.steps_per_mm[axis] = bad;
            CHECK(!check(cartesian).ok());
        }
}

TEST_CASE("kinematics 4, 5: the head is where its motors say, on every machine") {
    Delta delta{{100, 100, 100, 400}, {}};
    const std::array<double, 3> angles_rad{3.7, 5.74, 1.55}, radii_mm{120, 123, 118},
        arms_mm{250, 251.5, 248};
    for (std::size_t i = 0; i < 3; ++i)
        delta.towers[i] = {radii_mm[i] * std::cos(angles_rad[i]),
                           radii_mm[i] * std::sin(angles_rad[i]), arms_mm[i]};
    // Towers the other way round about the bed must not turn the head's place upside down.
    Delta mirrored = delta;
    for (Delta::Tower& tower : mirrored.towers) tower.x_mm = -tower.x_mm;
    const std::array<Kinematics, 4> machines{Cartesian{{80, 80, 400, 400}},
                                             CoreXy{{80, 80, 400, 400}}, delta, mirrored};
    for (const Kinematics& machine : machines)
        for (double x = -80; x <= 80; x += 13.7)
            for (double y = -80; y <= 80; y += 17.3)
                for (const double z : {-1.0, 0.0, 0.123, 150.0}) {
                    const Point at = head_at(machine, motors_at(machine, {x, y, z}));
                    CHECK(std::abs(at.x - x) < 1e-9);
                    CHECK(std::abs(at.y - y) < 1e-9);
                    CHECK(std::abs(at.z - z) < 1e-9);
                }
    CHECK(std::isnan(head_at(Kinematics(delta), {0, 900, 0}).z));
}

}  // namespace lyr::motion
