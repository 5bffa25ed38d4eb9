// What target/home/mover.h, homing.h and job.h say of the way itself: how high the head goes, and what contacts and stops
// do while it moves.

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

#include "target/gpio/mock_chip.h"
#include "target/home/job.h"
#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;
using config::Kinematics;

namespace {

// A machine whose contacts do what a test says at each step of x.
struct Bench {
    config::Printer printer = machine_of(Kinematics::cartesian);
    gpio::VirtualClock clock;
    bool is_broken = false;
    gpio::MockInputs inputs{
        3, clock, [this]() -> std::optional<Diagnostic> {
            if (!is_broken) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "the chip is gone", {}};
        }};
    int steps = 0;
    std::function<void(std::int64_t time_ns)> at_step;
    gpio::LineMask before = 0;
    gpio::MockChip chip{11, clock, [this](const gpio::LineWrite& write) {
                            const bool rises = (write.levels & ~before & run::step_bit(0)) != 0;
                            before = write.levels;
                            if (!rises) return;
                            ++steps;
                            if (at_step) at_step(write.time_ns);
                        }};
    Mover mover{printer, chip, clock, &inputs, nullptr};
    Bench() { printer.start_mm = {100, 100, 50}; }
};

}  // namespace

TEST_CASE("mover 1: inputs that fail bring the machine to rest, not only to an end") {
    Bench bench;
    bench.at_step = [&](std::int64_t) { bench.is_broken = bench.steps >= 800; };
    const auto moved = bench.mover.run(bench.printer, along_x(bench.printer, -80, 50), Contacts(1));
    REQUIRE_FALSE(moved.ok());
    CHECK(bench.steps < 800 + 400);
}

TEST_CASE(
    "mover 1: a contact that closes again while the machine comes to rest counts from its first "
    "touch") {
    Bench bench;
    bench.at_step = [&](std::int64_t time_ns) {
        if (bench.steps == 800) bench.inputs.set(0, true, time_ns);
        if (bench.steps == 880) bench.inputs.set(0, false, time_ns);
        if (bench.steps == 920) bench.inputs.set(0, true, time_ns);
    };
    const auto moved =
        bench.mover.run(bench.printer, along_x(bench.printer, -80, 100), Contacts(1));
    REQUIRE_MESSAGE(moved.ok(), moved.error().message);
    REQUIRE(moved->at_contact[0]);
    CHECK((*moved->at_contact[0])[0] == -800);
}

TEST_CASE(
    "mover 1: a second contact that closes while the machine comes to rest does not stop it dead") {
    Bench one, two;
    one.at_step = [&](std::int64_t time_ns) {
        if (one.steps == 800) one.inputs.set(0, true, time_ns);
    };
    two.at_step = [&](std::int64_t time_ns) {
        if (two.steps == 800) two.inputs.set(0, true, time_ns);
        if (two.steps == 810) two.inputs.set(1, true, time_ns);
    };
    const auto a = one.mover.run(one.printer, along_x(one.printer, -80, 100), Contacts(0b11));
    const auto b = two.mover.run(two.printer, along_x(two.printer, -80, 100), Contacts(0b11));
    REQUIRE(a.ok());
    REQUIRE(b.ok());
    CHECK(a->counts == b->counts);
    CHECK(b->at_contact[1]);
}

TEST_CASE("homing 2: a lift ends at the upper endstop of z") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.endstops[config::axis_z].at_high_end = true;
    printer.homing.order = {config::axis_x, config::axis_y, config::axis_z};
    printer.homing.lift_mm = 5;
    printer.simulated.head_mm = {100, 100, 99};
    home::SimulatedMachine machine(printer, {});
    HighestPlace chip(machine);
    home::Mover mover(printer, chip, machine.clock(), &machine.inputs(), nullptr);
    const auto homed = home::home(mover, printer, home::homable(printer));
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(chip.highest_mm() < 101);
}

TEST_CASE("homing 4: z by the probe homes x and y, too, so that the probe is over its place") {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.endstops[config::axis_z].input.reset();
    printer.simulated.head_mm = {40, 60, 20};
    printer.start_mm = {100, 100, 10};
    Scene scene(printer);
    const auto homed = home::home(scene.mover, printer, home::AxisSet(0b100));
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(scene.off_steps(homed->head) <= 1.01);
}

TEST_CASE("homing 6: the way to a higher place goes upwards first") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.simulated.head_mm = {10, 10, 5};
    printer.simulated.bumps = {{60, 35, 10, 20}};
    Scene scene(printer);
    REQUIRE(home::travel(scene.mover, printer, {10, 10, 5}, {110, 60, 15}).ok());
    CHECK(scene.machine.lowest_mm() > 0);
}

TEST_CASE("mover 3: nothing moves where a stop was asked for before") {
    Bench bench;
    Mover mover(bench.printer, bench.chip, bench.clock, &bench.inputs, [] { return 1u; });
    const auto moved = mover.run(bench.printer, along_x(bench.printer, -5, 50));
    REQUIRE_FALSE(moved.ok());
    CHECK(moved.error().status == ExitStatus::stopped);
    CHECK(bench.steps == 0);
    CHECK(bench.before == 0);
}

TEST_CASE("homing before a print 4: one that resumes below the end of z lifts no further") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.endstops[config::axis_z].at_high_end = false;
    printer.start_mm = {20, 20, 0};
    run::Resumption resumption;
    resumption.stopped_z_mm = 97;
    printer.simulated.head_mm = {120, 100, 97};
    home::SimulatedMachine machine(printer, {});
    HighestPlace chip(machine);
    home::Mover mover(printer, chip, machine.clock(), &machine.inputs(), nullptr);
    const Status homed = home::home_before_print(mover, printer, resumption);
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(chip.highest_mm() <= 100.01);
}
