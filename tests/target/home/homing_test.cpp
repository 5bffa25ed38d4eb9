// Contract of target/home/homing.h, by number, on simulated machines.

#include "target/home/homing.h"

#include <random>

#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::tests;
using config::Kinematics;

namespace {

// At its contact an axis may be anywhere within the step that touches it.
constexpr double a_step = 1.01;

void check_failure(const Result<home::Homed>& homed, const std::string& part) {
    REQUIRE_FALSE(homed.ok());
    CAPTURE(homed.error().message);
    CHECK(homed.error().status == ExitStatus::machine);
    CHECK(homed.error().message.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("homing 2: a head at the upper endstop of z was lifted into it first") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.endstops[config::axis_z].at_high_end = true;
    printer.simulated.head_mm = {100, 100, 100.1};
    home::SimulatedMachine machine(printer, {});
    HighestPlace chip(machine);
    home::Mover mover(printer, chip, machine.clock(), &machine.inputs(), nullptr);
    const auto homed = home::home(mover, printer, home::homable(printer));
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(chip.highest_mm() < 100.2);
}

TEST_CASE("homing 1: the head's place is found to a microstep, wherever it was") {
    std::mt19937 random(3);
    const auto within = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 100'000) / 1e5;
    };
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        for (int run = 0; run < 3; ++run) {
            config::Printer printer = machine_of(kind);
            const bool is_delta = kind == Kinematics::delta;
            printer.simulated.head_mm =
                is_delta ? std::array{within(-50, 50), within(-50, 50), within(1, 150)}
                         : std::array{within(1, 219), within(-4, 209), within(5, 90)};
            // Endstops at either end, and one beyond the range.
            printer.endstops[0].at_high_end = run == 1 || is_delta;
            printer.endstops[1].at_high_end = run >= 1 || is_delta;
            printer.endstops[2].at_high_end = run == 2 || is_delta;
            if (!is_delta) printer.endstops[1].at_mm = run >= 1 ? 213.37 : -6.2;
            if (is_delta) printer.endstops[1].at_mm = 200.123;
            CAPTURE(static_cast<int>(kind));
            CAPTURE(run);
            Scene scene(printer);
            const auto homed = scene.home();
            REQUIRE_MESSAGE(homed.ok(), homed.error().message);
            CHECK(scene.off_steps(homed->head) <= a_step);
            CHECK(homed->repeat_mm <= 0.02);
            CHECK(scene.machine.lowest_mm() > -0.6);
        }
    }
}

TEST_CASE("homing 1: shapers, a limit of jerk and contacts that bounce change nothing") {
    config::Printer printer = machine_of(Kinematics::corexy);
    printer.max_jerk_mm_s3 = 1e5;
    printer.shapers[0] = {config::ShaperKind::mzv, 40, 0.1};
    printer.shapers[1] = {config::ShaperKind::ei, 35, 0.1};
    std::vector<thermal::Fault> bounce;
    for (std::size_t i = 0; i < 3; ++i)
        bounce.push_back(fault(0, thermal::FaultKind::bounce, i, 1.5));
    Scene scene(printer, bounce);
    const auto homed = scene.home();
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(scene.off_steps(homed->head) <= a_step);
}

TEST_CASE("homing 2: an endstop that is touched at first is left, and found") {
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::delta}) {
        config::Printer printer = machine_of(kind);
        printer.simulated.head_mm =
            kind == Kinematics::delta ? std::array{0.0, 0.0, 200.4} : std::array{-0.5, 100.0, 50.0};
        Scene scene(printer);
        const auto homed = scene.home();
        REQUIRE_MESSAGE(homed.ok(), homed.error().message);
        CHECK(scene.off_steps(homed->head) <= a_step);
    }
}

TEST_CASE("homing 3: an endstop that never triggers is dead after the axis's length and margin") {
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Scene scene(machine_of(kind), {fault(0, thermal::FaultKind::dead, axis)});
            check_failure(scene.home(), "endstop " + std::string(config::axis_names[axis]) +
                                            " has not triggered within");
        }
}

TEST_CASE("homing 3: an endstop that stays triggered is stuck") {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Scene at_first(machine_of(Kinematics::cartesian),
                       {fault(0, thermal::FaultKind::stuck, axis)});
        check_failure(at_first.home(), "is still triggered after backing off by 3 mm");
        // In the middle of the way it triggers, and then for good.
        config::Printer printer = machine_of(Kinematics::cartesian);
        printer.homing.order = {axis, (axis + 1) % 3, (axis + 2) % 3};
        Scene later(printer, {fault(0.8, thermal::FaultKind::stuck, axis)});
        check_failure(later.home(), "is still triggered");
    }
}

TEST_CASE("homing 3: steps that get lost between two approaches are found") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.simulated.head_mm = {100, 100, 50};
    // After 5 s the fast approach of x is over, and the slow one begins.
    bool found = false;
    for (double time_s = 4.5; time_s < 7.5 && !found; time_s += 0.25) {
        Scene scene(printer, {fault(time_s, thermal::FaultKind::lose, 0, 20)});
        const auto homed = scene.home();
        if (!homed) check_failure(homed, "endstop x: two approaches differ by 0.2");
        found = !homed.ok();
    }
    CHECK(found);
}

TEST_CASE("homing 4: the probe homes z over its place, after x and y") {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.endstops[2].input.reset();
    printer.homing.order = {2, 0, 1};
    printer.probe->home_mm = {150, 60};
    printer.simulated.bumps = {{150, 60, 0.35, 10}};
    Scene scene(printer);
    const auto homed = scene.home();
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    // z = 0 is the bed where the probe was.
    motion::Point there = homed->head;
    there.z += 0.35;
    CHECK(scene.off_steps(there) <= a_step);
    CHECK(scene.machine.lowest_mm() > -0.2);
}

TEST_CASE("homing 4: a probe that never triggers ends it above the reach of the axis") {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.endstops[2].input.reset();
    Scene scene(printer, {fault(0, thermal::FaultKind::dead, config::contact_probe)});
    check_failure(scene.home(), "the probe has not triggered within 110.0 mm");
}

TEST_CASE("homing 4: what has no endstop is not homed, and says so") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.endstops[1].input.reset();
    Scene scene(printer);
    check_failure(home::home(scene.mover, printer, home::AxisSet(0b010)),
                  "no axis.y.endstop to home with");
    const auto homed = scene.home();
    REQUIRE(homed.ok());
    CHECK(homed->head.y == printer.start_mm[1]);
}

TEST_CASE("homing: inputs that fail end it with their message") {
    const config::Printer printer = machine_of(Kinematics::cartesian);
    home::SimulatedMachine machine(printer, {});
    int calls = 0;
    gpio::MockInputs inputs(3, machine.clock(), [&]() -> std::optional<Diagnostic> {
        if (++calls < 500) return std::nullopt;
        return Diagnostic{Severity::error, ExitStatus::machine, "the chip is gone", {}};
    });
    home::Mover mover(printer, machine.chip(), machine.clock(), &inputs, nullptr);
    check_failure(home::home(mover, printer, home::homable(printer)), "the chip is gone");
}

TEST_CASE("homing 5: a z axis that is homed first, downwards, is lifted before") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.homing.order = {config::axis_z, config::axis_x, config::axis_y};
    printer.simulated.head_mm = {100, 100, 50};
    home::SimulatedMachine machine(printer, {});
    HighestPlace chip(machine);
    home::Mover mover(printer, chip, machine.clock(), &machine.inputs(), nullptr);
    const auto homed = home::home(mover, printer, home::homable(printer));
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(chip.highest_mm() >= 50 + printer.homing.lift_mm);
}

TEST_CASE("homing 5: a z axis that homes upwards after others is lifted before they go sideways") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.endstops[config::axis_z].at_high_end = true;
    printer.simulated.head_mm = {120, 100, 10};
    printer.simulated.bumps = {{60, 100, 10 + printer.homing.lift_mm / 2, 20}};
    Scene scene(printer);
    REQUIRE(scene.home().ok());
    CHECK(scene.machine.lowest_mm() > 0);
}

TEST_CASE("homing 6: the way to a place goes upwards first and downwards last") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.simulated.head_mm = {10, 10, 5};
    Scene scene(printer);
    REQUIRE(home::travel(scene.mover, printer, {10, 10, 5}, {100, 50, 1}).ok());
    CHECK(scene.off_steps({100, 50, 1}) <= 0.51);
    CHECK(scene.machine.lowest_mm() > 0.99);
}

TEST_CASE(
    "homing 6: with backlash all motors arrive downwards, and high endstops are met with the play "
    "taken up") {
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        config::Printer printer = machine_of(kind);
        printer.backlash_mm = {0.1, 0.2, 0.15};
        gpio::VirtualClock clock;
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(8, clock, gpio::recorder(writes));
        home::Mover mover(printer, chip, clock, nullptr, nullptr);
        REQUIRE(home::travel(mover, printer, {10, 10, 5}, {40, 25, 9}).ok());
        for (std::size_t motor = 0; motor < 3; ++motor) {
            const double play = printer.backlash_mm[motor] * printer.axes[motor].steps_per_mm;
            // Of the motor, and of the axis, which may be behind it by the play or not.
            double at = 0, pushed = -play, pulled = 0;
            bool upwards = true;
            gpio::LineMask before = 0;
            for (const gpio::LineWrite& write : writes) {
                if (write.levels & ~before & run::step_bit(motor)) {
                    upwards = (write.levels & run::direction_bit(motor)) != 0;
                    at += upwards ? 1 : -1;
                    for (double* axis : {&pushed, &pulled})
                        *axis = std::clamp(*axis, at - play, at);
                }
                before = write.levels;
            }
            CHECK_FALSE(upwards);
            CHECK(pushed == at);
            CHECK(pulled == at);
        }
    }
    config::Printer printer = machine_of(Kinematics::cartesian);
    for (config::Endstop& endstop : printer.endstops) endstop.at_high_end = true;
    Scene plain(printer);
    printer.backlash_mm = {0.1, 0.2, 0.15};
    Scene played(printer);
    const auto a = plain.home(), b = played.home();
    REQUIRE(a.ok());
    REQUIRE(b.ok());
    // The simulated axes have no play: what is taken off for it shows.
    CHECK(b->head.x - played.machine.head().x ==
          doctest::Approx(a->head.x - plain.machine.head().x + 0.1).epsilon(1e-3));
}

TEST_CASE("homing: an endstop farther beyond its axis than the margin was taken for dead") {
    for (const bool high : {false, true}) {
        config::Printer printer = machine_of(config::Kinematics::cartesian);
        const config::Axis& x = printer.axes[config::axis_x];
        printer.endstops[config::axis_x].at_high_end = high;
        printer.endstops[config::axis_x].at_mm = high ? x.max_mm + 30 : x.min_mm - 30;
        printer.simulated.head_mm = {high ? x.min_mm : x.max_mm, 100, 50};
        Scene scene(printer);
        const Result<home::Homed> homed = scene.home();
        REQUIRE_MESSAGE(homed.ok(), (homed.ok() ? "" : to_string(homed.error())));
        CHECK(scene.off_steps(homed->head) < 1);
    }
}

TEST_CASE("homing: a simulated machine of 25 mm began beyond its own axes") {
    config::Printer printer = machine_of(config::Kinematics::cartesian);
    for (const std::size_t axis : {config::axis_x, config::axis_y, config::axis_z}) {
        printer.axes[axis].min_mm = 0;
        printer.axes[axis].max_mm = 25;
        printer.homing.margin_mm = 1;
    }
    Scene scene(printer);
    const Result<home::Homed> homed = scene.home();
    REQUIRE_MESSAGE(homed.ok(), (homed.ok() ? "" : to_string(homed.error())));
    CHECK(scene.off_steps(homed->head) < 1);
}
