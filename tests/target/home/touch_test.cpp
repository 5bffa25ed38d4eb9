// Contract of target/home/touch.h, by number, where homing as a whole does not show it: how fast and how far axes go.

#include "target/home/touch.h"

#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;
using config::Kinematics;

namespace {

// When each motor steps, and which way.
class StepTimes final : public gpio::GpioChip {
public:
    struct Stepped {
        std::int64_t time_ns;
        bool upwards;
    };

    explicit StepTimes(SimulatedMachine& machine) : machine_(machine) {}
    std::size_t line_count() const override { return machine_.chip().line_count(); }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        const gpio::LineMask before = machine_.chip().levels();
        Status written = machine_.chip().write(changed, levels);
        const gpio::LineMask after = machine_.chip().levels();
        for (std::size_t i = 0; i < steps_.size(); ++i)
            if (~before & after & run::step_bit(i))
                steps_[i].push_back(
                    {machine_.clock().now_ns(), (after & run::direction_bit(i)) != 0});
        return written;
    }
    Status release() override { return machine_.chip().release(); }

    // The least time of so many intervals between steps of one direction; none: there are not as many.
    std::optional<std::int64_t> least_ns(std::size_t motor, bool upwards, std::size_t count) const {
        const std::vector<Stepped>& steps = steps_[motor];
        std::optional<std::int64_t> least_ns;
        std::size_t same = 0;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            same = steps[i].upwards == upwards ? same + 1 : 0;
            if (same <= count) continue;
            const std::int64_t time_ns = steps[i].time_ns - steps[i - count].time_ns;
            least_ns = std::min(least_ns.value_or(time_ns), time_ns);
        }
        return least_ns;
    }

private:
    SimulatedMachine& machine_;
    std::array<std::vector<Stepped>, 3> steps_;
};

struct Timed {
    config::Printer printer;
    SimulatedMachine machine{printer, {}};
    StepTimes chip{machine};
    Mover mover{printer, chip, machine.clock(), &machine.inputs(), nullptr};

    // As is seen over a millimetre, to a step of it.
    bool reaches(std::size_t motor, bool upwards, double mm_s) const {
        return within(motor, upwards, mm_s, 1);
    }
    bool exceeds(std::size_t motor, bool upwards, double mm_s) const {
        return within(motor, upwards, mm_s, -1);
    }

private:
    bool within(std::size_t motor, bool upwards, double mm_s, double more_steps) const {
        const double steps = printer.axes[motor].steps_per_mm;
        const auto least_ns = chip.least_ns(motor, upwards, static_cast<std::size_t>(steps));
        return least_ns &&
               static_cast<double>(*least_ns) <= (steps + more_steps) / (steps * mm_s) * 1e9;
    }
};

}  // namespace

TEST_CASE(
    "homing 2: each tower of a delta comes as fast as its endstop says, alone or with others") {
    for (const double height_mm : {20.0, 120.0}) {
        config::Printer printer = machine_of(Kinematics::delta);
        // Beside the middle: the towers come one after another.
        printer.simulated.head_mm = {60, 20, height_mm};
        Timed scene{printer};
        REQUIRE(home::home(scene.mover, printer, homable(printer)).ok());
        for (std::size_t tower = 0; tower < 3; ++tower) {
            const double fast_mm_s = printer.endstops[tower].fast_mm_s;
            CHECK(scene.reaches(tower, true, fast_mm_s));
            CHECK_FALSE(scene.exceeds(tower, true, fast_mm_s));
        }
    }
}

TEST_CASE("homing 5: a z axis that is homed first, upwards, comes to its endstop without a lift") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.homing.order = {config::axis_z, config::axis_x, config::axis_y};
    config::Endstop& endstop = printer.endstops[config::axis_z];
    endstop.at_high_end = true;
    endstop.fast_mm_s = 4;
    // The lift would end in the endstop, at the speed of z.
    printer.simulated.head_mm = {100, 100, 100 - printer.homing.lift_mm / 2};
    Timed scene{printer};
    REQUIRE(home::home(scene.mover, printer, homable(printer)).ok());
    CHECK_FALSE(scene.exceeds(config::axis_z, true, endstop.fast_mm_s));
}

TEST_CASE("touch 2: contacts are left no faster than the slowest of them") {
    for (const std::size_t slower : {0u, 1u}) {
        config::Printer printer = machine_of(Kinematics::cartesian);
        printer.start_mm = {100, 100, 50};
        printer.simulated.head_mm = printer.start_mm;
        Timed scene{printer};
        ByAxes machine(scene.mover, printer);
        std::array<Target, 2> targets;
        for (std::size_t axis = 0; axis < 2; ++axis)
            targets[axis] = {axis, axis, -1, 300, 0, axis == slower ? 10.0 : 100.0, 2, 20, 0.05};
        // What is never touched fails later, and the way back is made all the same.
        CHECK_FALSE(machine.touch_slowly(targets, printer.start_mm).ok());
        for (std::size_t axis = 0; axis < 2; ++axis)
            CHECK_FALSE(scene.exceeds(axis, true, targets[slower].fast_mm_s));
    }
}

TEST_CASE("homing 3: how far a dead tower goes does not depend on how soon the others are there") {
    for (std::size_t dead = 0; dead < 3; ++dead) {
        const auto went_from = [&](const std::array<double, 3>& head_mm) {
            config::Printer printer = machine_of(Kinematics::delta);
            printer.simulated.head_mm = head_mm;
            Scene scene(printer, {fault(0, thermal::FaultKind::dead, dead)});
            CHECK_FALSE(scene.home().ok());
            return scene.mover.counts()[dead];
        };
        const std::int64_t from_below = went_from({60, 20, 20});
        CHECK(from_below > 200 * 100);
        CHECK(std::abs(went_from({-30, 50, 120}) - from_below) <= 1);
    }
}

TEST_CASE("homing 2: the towers of a delta all went as fast as the first one's endstop said") {
    config::Printer printer = machine_of(Kinematics::delta);
    printer.simulated.head_mm = {60, 20, 120};
    printer.endstops[0].fast_mm_s = 40;
    printer.endstops[1].fast_mm_s = printer.endstops[2].fast_mm_s = 10;
    Timed scene{printer};
    REQUIRE(home::home(scene.mover, printer, homable(printer)).ok());
    for (std::size_t tower = 0; tower < 3; ++tower)
        for (const bool upwards : {true, false}) {
            CAPTURE(tower);
            CAPTURE(upwards);
            CHECK_FALSE(scene.exceeds(tower, upwards, printer.endstops[tower].fast_mm_s));
        }
}
