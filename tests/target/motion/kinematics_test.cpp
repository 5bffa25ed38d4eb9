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

}  // namespace lyr::motion
