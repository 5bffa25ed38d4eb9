// Contract of target/run/life.h, by number, and what executor.h (9 to 11), course.h and trip.h say of rests and trips: in
// simulations, whose checks hold every step of the path against the file and the plan.

#include "target/run/life.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "target/gpio/mock_chip.h"
#include "target/run/patient_printer.h"
#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

Result<SimulationReport> simulated(const std::string& file, const std::string& script,
                                   const config::Printer& printer = parking_printer(),
                                   bool no_heat = true) {
    const auto commands = parse_script(script, "script");
    REQUIRE_MESSAGE(commands.ok(), (commands.ok() ? "" : to_string(commands.error())));
    SimulationJob job{file, printer, {}, {}, {}};
    job.script = *commands;
    job.no_heat = no_heat;
    return simulate(job);
}

void check_same_path(const SimulationReport& a, const SimulationReport& b) {
    CHECK(a.positions == b.positions);
    for (std::size_t i = 0; i < config::axis_count; ++i) {
        CHECK(a.pulses[i].steps == b.pulses[i].steps);
        CHECK(a.pulses[i].reversals == b.pulses[i].reversals);
    }
    CHECK(a.writes == b.writes);
    CHECK(a.print_time_s == b.print_time_s);
    CHECK(a.within_limits());
}

const std::string& cold_file() {
    static const std::string file = write_print(
        "life", {draw_square, draw_arcs, draw_hatch, draw_climb, draw_circles, draw_wipes});
    return file;
}

}  // namespace

TEST_CASE("life 1: a print that pauses at any time makes the same steps as one that does not" *
          doctest::test_suite("long")) {
    const Result<SimulationReport> plain = simulated(cold_file(), "");
    REQUIRE_MESSAGE(plain.ok(), message_of(plain));
    const double print_s = plain->print_time_s;
    for (int i = 0; i < 11; ++i) {
        const double at_s = print_s * i / 11;
        const Result<SimulationReport> paused = simulated(
            cold_file(), std::to_string(at_s) + " pause\n" + std::to_string(at_s + 30) + " resume");
        REQUIRE_MESSAGE(paused.ok(), message_of(paused));
        CAPTURE(at_s);
        check_same_path(*paused, *plain);
        CHECK(paused->trip_steps == plain->trip_steps);
        CHECK(paused->paused_s > 29.8);
        CHECK(paused->paused_s < 35);
    }
}

TEST_CASE("life 1: so it is on crossed belts, on a delta, with shaping, jerk and pressure advance" *
          doctest::test_suite("long")) {
    config::Printer belts = parking_printer(), delta = parking_printer(),
                    shaped = parking_printer();
    belts.kinematics = config::Kinematics::corexy;
    delta.kinematics = config::Kinematics::delta;
    delta.delta = {{250, 250, 250}, {120, 120, 120}, {210, 330, 90}, 120};
    delta.pause.park_mm = {{-40, 60}};
    for (auto& shaper : shaped.shapers) shaper = {config::ShaperKind::mzv, 40, 0.1};
    shaped.pressure_advance_s = 0.04;
    shaped.max_jerk_mm_s3 = 100'000;
    const std::string file = write_print("life_machines", {draw_arcs, draw_wipes});
    for (const config::Printer& printer : {belts, delta, shaped}) {
        const Result<SimulationReport> plain = simulated(file, "", printer);
        REQUIRE_MESSAGE(plain.ok(), message_of(plain));
        for (const double share : {0.31, 0.52, 0.77}) {
            const std::string at_s = std::to_string(plain->print_time_s * share);
            const Result<SimulationReport> paused =
                simulated(file, at_s + " pause\n100 resume", printer);
            REQUIRE_MESSAGE(paused.ok(), message_of(paused));
            CAPTURE(at_s);
            check_same_path(*paused, *plain);
            CHECK(paused->trip_steps == plain->trip_steps);
        }
    }
}

TEST_CASE("life 1: pauses follow each other, and one may come while the head goes back" *
          doctest::test_suite("long")) {
    const Result<SimulationReport> plain = simulated(cold_file(), "");
    REQUIRE(plain.ok());
    for (const char* script :
         {"2 pause\n30 resume\n31 pause\n60 resume\n61 pause\n90 resume",
          "2 pause\n30 resume\n30.3 pause\n60 resume", "2 pause\n2.1 resume\n2.2 pause\n60 resume",
          "2 pause\n2.1 pause\n30 pause\n60 resume\n60.1 resume",
          "2 pause\n40 resume\n40.1 pause\n"
          "40.2 resume\n80 resume"}) {
        CAPTURE(script);
        const Result<SimulationReport> paused = simulated(cold_file(), script);
        REQUIRE_MESSAGE(paused.ok(), message_of(paused));
        check_same_path(*paused, *plain);
        CHECK(paused->trip_steps == plain->trip_steps);
    }
}

TEST_CASE("life 1, 2: a change of filament leaves behind what it purges, and no step of the head" *
          doctest::test_suite("long")) {
    const Result<SimulationReport> plain = simulated(cold_file(), "");
    REQUIRE(plain.ok());
    config::Printer printer = parking_printer();
    printer.filament.load_mm = 90;
    const auto pushed_steps = [&](double length_mm) {
        return std::llround(length_mm * printer.axes[config::axis_e].steps_per_mm);
    };
    for (const char* script :
         {"4 change_filament\n90 resume", "4 pause\n40 change_filament\n90 resume"}) {
        CAPTURE(script);
        const Result<SimulationReport> changed = simulated(cold_file(), script, printer);
        REQUIRE_MESSAGE(changed.ok(), message_of(changed));
        check_same_path(*changed, *plain);
        for (std::size_t i = 0; i < 3; ++i) CHECK(changed->trip_steps[i] == plain->trip_steps[i]);
        // Drawn back before it was drawn out, then in by more, the purge, and what a nozzle needs to be ready.
        const double left_mm = -2 - 80 + 90 + 30;
        const auto left_steps =
            changed->trip_steps[config::axis_e] - plain->trip_steps[config::axis_e];
        CHECK(std::abs(left_steps - pushed_steps(left_mm)) <= 3);
    }
}

TEST_CASE(
    "life 2, 3: a pause that lasts lets the heaters go cold, and the print heats them again") {
    const std::string file =
        write_print("life_hot", {draw_square, draw_arcs, draw_circles}, {}, heated(210, 60));
    config::Printer printer = parking_printer();
    printer.pause.tool_off_s = 60;
    printer.pause.bed_off_s = 300;
    const Result<SimulationReport> plain = simulated(file, "", printer, false);
    REQUIRE_MESSAGE(plain.ok(), message_of(plain));
    const double begin_s = plain->waited_s;
    const auto paused_for = [&](double rest_s, std::vector<PrintStatus>& seen) {
        PrintControl control;
        SimulationJob job{file, printer, {}, {}, {}};
        job.script = {{begin_s + 5, Pause{}}, {begin_s + 5 + rest_s, Resume{}}};
        for (double at_s = begin_s + 10; at_s < begin_s + rest_s + 300; at_s += 5)
            job.script.push_back({at_s, SetSpeedFactor{1}});
        std::stable_sort(job.script.begin(), job.script.end(),
                         [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
        job.control = &control;
        job.stop = [] { return false; };
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_MESSAGE(report.ok(), message_of(report));
        check_same_path(*report, *plain);
        seen.push_back(control.status());
        return report;
    };
    std::vector<PrintStatus> ends;
    const auto brief = paused_for(30, ends), cold = paused_for(400, ends);
    for (const PrintStatus& end : ends) {
        CHECK(end.state == PrintState::done);
        CHECK(end.layer == 3);
        CHECK(end.layers == 3);
        CHECK(end.is_position_known);
    }
    CHECK(brief->paused_s > 20);
    CHECK(cold->paused_s > 390);
    // The second one was heated twice.
    CHECK(cold->heat[0].full_power_s > brief->heat[0].full_power_s);
    CHECK(ends[1].elapsed_s - ends[0].elapsed_s > 370 + 60);
}

TEST_CASE("life 2: a tool that was set to 0 in a pause pushed its filament cold after the resume") {
    const std::string file =
        write_print("life_set_cold", {draw_square, draw_circles}, {}, heated(210, 60));
    const Result<SimulationReport> plain = simulated(file, "", parking_printer(), false);
    REQUIRE_MESSAGE(plain.ok(), message_of(plain));
    const auto at = [&](double after_s) { return std::to_string(plain->waited_s + after_s) + ' '; };
    const std::string cold = at(2) + "pause\n" + at(20) + "set tool 0\n" + at(60) + "resume\n";
    const Result<SimulationReport> refused = simulated(file, cold, parking_printer(), false);
    CHECK(message_of(refused).find("the print rests") != std::string::npos);
    const Result<SimulationReport> warm = simulated(
        file, cold + at(61) + "set tool 210\n" + at(62) + "resume\n", parking_printer(), false);
    REQUIRE_MESSAGE(warm.ok(), message_of(warm));
    check_same_path(*warm, *plain);
}

TEST_CASE("life 4: a cancel parks the head and ends; so it does in a pause and on the way back") {
    for (const char* script : {"0.1 cancel", "4 cancel", "4 pause\n4.2 cancel",
                               "4 pause\n60 cancel", "4 pause\n60 resume\n60.2 cancel"}) {
        CAPTURE(script);
        PrintControl control;
        SimulationJob job{cold_file(), parking_printer(), {}, {}, {}};
        job.no_heat = true;
        job.control = &control;
        job.script = *parse_script(script, "script");
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().status == ExitStatus::stopped);
        CHECK(report.error().message.find("cancelled") != std::string::npos);
        const PrintStatus end = control.status();
        CHECK(end.state == PrintState::stopped);
        CHECK(end.is_position_known);
        CHECK(end.position_mm[0] == doctest::Approx(5).epsilon(0.01));
        CHECK(end.position_mm[1] == doctest::Approx(120).epsilon(0.01));
        CHECK(end.position_mm[2] > 5);
    }
}

TEST_CASE("life 4: an emergency stop ends at once, and the position is lost") {
    for (const char* script :
         {"4 emergency_stop", "4 pause\n4.2 emergency_stop", "4 pause\n60 emergency_stop",
          "4 pause\n60 resume\n60.2 emergency_stop"}) {
        CAPTURE(script);
        PrintControl control;
        SimulationJob job{cold_file(), parking_printer(), {}, {}, {}};
        job.no_heat = true;
        job.control = &control;
        job.script = *parse_script(script, "script");
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().status == ExitStatus::stopped);
        CHECK(report.error().message.find("position of the head is lost") != std::string::npos);
        CHECK_FALSE(control.status().is_position_known);
    }
}

TEST_CASE("life 5: what cannot be done is refused, and the print goes on as before" *
          doctest::test_suite("long")) {
    const Result<SimulationReport> plain = simulated(cold_file(), "");
    REQUIRE(plain.ok());
    const auto refusal = [&](const std::string& script, bool no_heat = true) {
        PrintControl control;
        SimulationJob job{cold_file(), parking_printer(), {}, {}, {}};
        job.no_heat = no_heat;
        job.control = &control;
        job.script = *parse_script(script, "script");
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_MESSAGE(report.ok(), message_of(report));
        check_same_path(*report, *plain);
        // Refusals of a script were lost without a status to look at.
        const std::string message = control.status().message;
        CHECK(report->notes.empty() == message.empty());
        if (!message.empty())
            CHECK(report->notes.back().message.find("s: " + message) != std::string::npos);
        return message;
    };
    CHECK(refusal("4 resume") == "refused `resume`: the print does not rest");
    CHECK(refusal("4 set chamber 40") ==
          "refused `set chamber 40`: the printer has no heater chamber");
    CHECK(refusal("4 set tool 271") == "refused `set tool 271`: heater tool goes up to 270 °C");
    CHECK(refusal("4 set tool 100").find("pause first") != std::string::npos);
    CHECK(refusal("4 fan 0.5").empty());
    const Result<SimulationReport> late = simulated(cold_file(), "9999 fan 0.5");
    REQUIRE(late.ok());
    REQUIRE(late->notes.size() == 1);
    CHECK(late->notes[0].message.find("1 command of the script came after") != std::string::npos);
    config::Printer plain_printer = parking_printer();
    plain_printer.part_fan.reset();
    CHECK(objection(SetFan{1}, plain_printer) == "the printer has no part fan");
    CHECK_FALSE(objection(SetFan{1}, parking_printer()));
    CHECK_FALSE(objection(Pause{}, plain_printer));
}

TEST_CASE("executor 9: half the speed takes twice as long, and the path is the same") {
    PrintControl control;
    // At its end the head has no way to go: that is no part of the path.
    config::Printer printer = config::generic_printer();
    printer.pause.lift_mm = printer.pause.retract_mm = 0;
    const Result<SimulationReport> plain = simulated(cold_file(), "", printer);
    REQUIRE(plain.ok());
    SimulationJob job{cold_file(), printer, {}, {}, {}};
    job.no_heat = true;
    job.control = &control;
    job.script = *parse_script("0.1 speed 0.5", "script");
    const Result<SimulationReport> slow = simulate(job);
    REQUIRE_MESSAGE(slow.ok(), message_of(slow));
    check_same_path(*slow, *plain);
    CHECK(control.status().elapsed_s == doctest::Approx(2 * plain->print_time_s).epsilon(0.03));
    CHECK(control.status().speed_factor == 0.5);
    // The report's times were those of full speed alone.
    CHECK(slow->slowed_s == doctest::Approx(plain->print_time_s).epsilon(0.03));
    CHECK(text_of(*slow).find("more at the lower speed") != std::string::npos);
    CHECK(plain->slowed_s == 0);
    CHECK(control.status().filament_mm > 0);
}

TEST_CASE("step stream: a higher speed is planned, a lower one after it comes by the pace" *
          doctest::test_suite("long")) {
    // Moves enough that not all of them are planned at once, on few steps.
    const auto to_and_fro = [](const Pen& pen) {
        pen.path();
        pen.travel(0, 0);
        for (int i = 1; i <= 3'000; ++i) pen.line(0.5 * (i % 60 < 30 ? i % 60 : 60 - i % 60), 0);
    };
    const std::string file = write_print("life_fast", {to_and_fro});
    const auto with = [&](const std::string& script) {
        PrintControl control;
        SimulationJob job{file, parking_printer(), {}, {}, {}};
        job.no_heat = true;
        job.control = &control;
        job.script = *parse_script(script, "script");
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_MESSAGE(report.ok(), message_of(report));
        CHECK(report->within_limits());
        return std::pair(report->positions, control.status().elapsed_s);
    };
    const auto [plain_end, plain_s] = with("");
    const auto [fast_end, fast_s] = with("5 speed 2");
    const auto [back_end, back_s] =
        with("5 speed 2\n" + std::to_string(plain_s * 0.6) + " speed 0.5");
    CHECK(fast_end == plain_end);
    CHECK(back_end == plain_end);
    CHECK(fast_s < 0.9 * plain_s);
    CHECK(back_s > fast_s * 1.1);
    CHECK(with("5 speed 2").second == fast_s);
}

TEST_CASE(
    "heat order 4: a file that pauses goes on when it is told to; without anybody it is refused") {
    const auto pausing = [](format::PauseReason reason) {
        return [=](const Pen& pen) {
            pen.path();
            pen.travel(0, 0);
            pen.line(10, 0);
            pen.layer.pause(reason);
            pen.line(20, 0);
            pen.arc(20, 10, 3);
        };
    };
    const std::string file =
        write_print("life_pauses", {draw_square, pausing(format::PauseReason::user),
                                    pausing(format::PauseReason::filament_change)});
    const Result<SimulationReport> paused = simulated(file, "60 resume\n120 resume\n");
    REQUIRE_MESSAGE(paused.ok(), message_of(paused));
    CHECK(paused->within_limits());
    CHECK(paused->paused_s > 100);
    const Result<SimulationReport> forgotten = simulated(file, "60 resume");
    REQUIRE_FALSE(forgotten.ok());
    CHECK(forgotten.error().status == ExitStatus::stopped);
    const Result<SimulationReport> passed = simulated(file, "");
    REQUIRE(passed.ok());
    CHECK(passed->positions == paused->positions);
    CHECK(paused->trip_steps[config::axis_x] == passed->trip_steps[config::axis_x]);
    CHECK(paused->trip_steps[config::axis_e] > passed->trip_steps[config::axis_e]);
    REQUIRE_FALSE(passed->notes.empty());
    CHECK(passed->notes.back().message.find("nobody") != std::string::npos);
}

TEST_CASE("trip 3, 4: where the head is follows from its motors, whatever machine and bed") {
    config::Printer printer = config::generic_printer();
    printer.start_mm = {3, -4, 12};
    printer.mesh.area_mm = {-100, -100, 100, 100};
    SUBCASE("a flat bed") {}
    SUBCASE("a crooked bed") {
        printer.mesh.heights_mm = {{-1, 1}, {0, 2}};
    }
    for (const auto kind :
         {config::Kinematics::cartesian, config::Kinematics::corexy, config::Kinematics::delta}) {
        printer.kinematics = kind;
        printer.delta = {{250, 251, 249}, {120, 121, 119}, {209, 331, 90}, 120};
        for (const motion::Point& to : {motion::Point{3, -4, 12}, motion::Point{50, 20, 40},
                                        motion::Point{-70, -60, 0.2}, motion::Point{0, 110, 100}}) {
            const std::array<Leg, 1> legs{{{to, 0, 200}}};
            const Result<Trip> trip = plan_trip(printer, {3, -4, 12}, legs, 0);
            REQUIRE(trip.ok());
            gpio::VirtualClock clock;
            gpio::MockChip chip(8, clock, {});
            const StopRequests stop{0};
            Executor executor(chip, clock, executor_timing(printer), stop);
            executor.begin_trip();
            REQUIRE(executor.execute(*trip).ok());
            executor.end_trip();
            const motion::Point at = head_at(printer, executor.trip_steps());
            CHECK(std::abs(at.x - to.x) < 0.05);
            CHECK(std::abs(at.y - to.y) < 0.05);
            CHECK(std::abs(at.z - to.z) < 0.02);
            CHECK(executor.levels() == 0);
        }
    }
}
