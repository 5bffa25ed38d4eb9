// What must hold whatever happens, in virtual time: heaters off within a second, the position of the head kept or declared
// lost, one clear line. docs/safety.md lists the scenarios.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

StateChange hot() {
    return [](format::LayerState& state) {
        state.temperatures.push_back({{format::HeaterKind::bed, 0}, 60});
        state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
    };
}

const std::string& hot_file() {
    static const std::string file =
        write_print("safety", {draw_square, draw_arcs, draw_circles, draw_climb}, {}, hot());
    return file;
}

config::Printer small_printer() {
    config::Printer printer = config::generic_printer();
    printer.pause.park_mm = {{5, 120}};
    printer.pause.tool_off_s = 30;
    return printer;
}

// What became of a print.
struct End {
    std::string message;
    ExitStatus status = ExitStatus::ok;
    double last_on_s = 0;  // when a heater was on last
    bool is_on = false;
    PrintStatus print;
};

End end_of(SimulationJob job, const std::string& script = "") {
    End end;
    PrintControl control;
    job.printer = small_printer();
    job.script = *parse_script(script, "script");
    job.control = &control;
    job.heat_watch = [&](double time_s, bool any_heater_on) {
        end.is_on = any_heater_on;
        if (any_heater_on) end.last_on_s = time_s;
    };
    const Result<SimulationReport> report = simulate(job);
    if (!report) end.status = report.error().status;
    if (!report) end.message = to_string(report.error());
    end.print = control.status();
    return end;
}

SimulationJob job_of(const std::string& file = hot_file()) {
    return {file, small_printer(), {}, {}, {}};
}

// When the path begins, after heating.
double warm_s() {
    static const double found_s = [] {
        const Result<SimulationReport> report = simulate(job_of());
        REQUIRE(report.ok());
        return report->waited_s;
    }();
    return found_s;
}

std::string at(double time_s, const std::string& command) {
    return std::to_string(time_s) + ' ' + command + '\n';
}

std::string pause_script() {
    return at(warm_s() + 5, "pause") + at(warm_s() + 105, "resume");
}

// The hours of a print with a pause in which the tool goes cold.
struct Hour {
    const char* name;
    double time_s;
};

const std::vector<Hour>& hours() {
    static const std::vector<Hour> found = [] {
        const double warm = warm_s();
        std::vector<Hour> all{{"cold", 1},
                              {"heating", warm / 2},
                              {"printing", warm + 4},
                              {"resting", warm + 20},
                              {"resting cold", warm + 60},
                              {"heating again", warm + 110}};
        // Those that are brief, by when the print came to them.
        PrintControl control;
        SimulationJob job = job_of();
        job.script = *parse_script(pause_script(), "script");
        job.control = &control;
        PrintState before = PrintState::heating;
        job.heat_watch = [&](double time_s, bool) {
            const PrintState now = control.status().state;
            if (now == PrintState::pausing && before == PrintState::printing)
                all.push_back({"coming to rest", time_s}), all.push_back({"parking", time_s + 0.7});
            if (now == PrintState::printing && before == PrintState::resuming)
                all.push_back({"coming back", time_s - 0.5}),
                    all.push_back({"printing again", time_s + 1});
            before = now;
        };
        REQUIRE(simulate(job).ok());
        REQUIRE(all.size() == 10);
        return all;
    }();
    return found;
}

void check_safe(const End& end, double fault_s, ExitStatus status, const std::string& part) {
    CAPTURE(end.message);
    CHECK(end.status == status);
    CHECK_FALSE(end.is_on);
    CHECK(end.last_on_s <= fault_s + 1);
    CHECK(end.message.find(part) != std::string::npos);
    CHECK(end.message.find('\n') == std::string::npos);
    CHECK(end.print.state ==
          (status == ExitStatus::stopped ? PrintState::stopped : PrintState::failed));
    CHECK(end.print.message.find(part) != std::string::npos);
}

Diagnostic bus_error() {
    return {Severity::error, ExitStatus::machine, "bus error", {}};
}

gpio::MockChip::Fault failing_at(std::uint64_t number) {
    return [number](std::uint64_t now) -> std::optional<Diagnostic> {
        return now == number ? std::optional(bus_error()) : std::nullopt;
    };
}

}  // namespace

TEST_CASE("safety: a signal, once or twice, at every hour of a print" *
          doctest::test_suite("long")) {
    for (const Hour& hour : hours())
        for (const int count : {1, 2}) {
            CAPTURE(hour.name);
            CAPTURE(count);
            SimulationJob job = job_of();
            job.line_faults.signals_s.assign(static_cast<std::size_t>(count), hour.time_s);
            const End end = end_of(job, pause_script());
            check_safe(end, hour.time_s, ExitStatus::stopped, "stopped on request");
            CHECK(end.print.is_position_known == (count == 1));
        }
}

TEST_CASE("safety: an emergency stop at every hour of a print") {
    for (const Hour& hour : hours()) {
        CAPTURE(hour.name);
        const End end = end_of(job_of(), pause_script() + at(hour.time_s, "emergency_stop"));
        check_safe(end, hour.time_s, ExitStatus::stopped, "emergency stop");
        CHECK_FALSE(end.print.is_position_known);
        CHECK(end.message.find("lost") != std::string::npos);
    }
}

TEST_CASE("safety: a cancel at every hour of a print" * doctest::test_suite("long")) {
    for (const Hour& hour : hours()) {
        CAPTURE(hour.name);
        const End end = end_of(job_of(), pause_script() + at(hour.time_s, "cancel"));
        check_safe(end, hour.time_s, ExitStatus::stopped, "cancelled");
        CHECK(end.print.is_position_known);
    }
}

TEST_CASE("safety: a sensor that breaks at every hour of a print" * doctest::test_suite("long")) {
    for (const Hour& hour : hours())
        for (const char* fault : {"open tool", "short bed", "unreadable tool", "jump bed 60"}) {
            CAPTURE(hour.name);
            CAPTURE(fault);
            SimulationJob job = job_of();
            job.faults = *thermal::parse_faults(at(hour.time_s, fault), "f", small_printer());
            const End end = end_of(job, pause_script());
            check_safe(end, hour.time_s, ExitStatus::machine, "heater");
            CHECK(end.print.is_position_known);
            CHECK(end.message.find("lyrrun is started again") != std::string::npos);
        }
}

TEST_CASE("safety: a heater that burns out or sticks, in a pause and on the way back from it") {
    const double warm = warm_s();
    struct Burn {
        double time_s;
        const char *fault, *part;
    };
    for (const Burn& burn :
         {Burn{warm + 10, "no_power bed", "bed"}, Burn{warm + 50, "stuck_on tool", "tool"},
          Burn{warm + 104, "no_power tool", "tool"}, Burn{warm + 20, "silent", "silent"},
          Burn{warm + 110, "silent", "silent"}}) {
        CAPTURE(burn.fault);
        SimulationJob job = job_of();
        job.faults = *thermal::parse_faults(at(burn.time_s, burn.fault), "f", small_printer());
        const End end = end_of(job, pause_script() + at(warm + 400, "fan 0"));
        // When the guard fires is its own matter; then nothing stays on.
        check_safe(end, end.print.elapsed_s, ExitStatus::machine, burn.part);
        CHECK(end.print.is_position_known);
    }
}

TEST_CASE(
    "safety: a motor's line that cannot be written, at the first, any and the last write, and on a "
    "trip") {
    const Result<SimulationReport> whole = simulate(job_of());
    REQUIRE(whole.ok());
    const std::uint64_t writes = whole->writes;
    for (const std::uint64_t number :
         {std::uint64_t{0}, std::uint64_t{1}, writes / 3, writes / 2, writes - 2}) {
        CAPTURE(number);
        SimulationJob job = job_of();
        job.line_faults.motors = failing_at(number);
        const End end = end_of(job);
        check_safe(end, end.print.elapsed_s, ExitStatus::machine, "bus error");
        CHECK_FALSE(end.print.is_position_known);
    }
    SimulationJob job = job_of();
    std::uint64_t trip_write = 0;
    job.line_faults.motors = [&](std::uint64_t now) -> std::optional<Diagnostic> {
        trip_write = now;
        return now == writes / 2 + 3'000 ? std::optional(bus_error()) : std::nullopt;
    };
    const End end = end_of(job, at(warm_s() + 5, "pause") + at(warm_s() + 25, "resume"));
    check_safe(end, end.print.elapsed_s, ExitStatus::machine, "bus error");
}

TEST_CASE("safety: a heater's line that cannot be written, at the first, any and a late write") {
    for (const std::uint64_t number : {0u, 1u, 40u, 700u, 1'500u}) {
        CAPTURE(number);
        SimulationJob job = job_of();
        job.line_faults.heaters = failing_at(number);
        const End end = end_of(job);
        const double failed_s = static_cast<double>(number + 1) / 10;
        check_safe(end, failed_s, ExitStatus::machine, "cannot be switched");
        CHECK(end.print.is_position_known);
    }
}

TEST_CASE("safety: a file that is cut or changed while it is printed" *
          doctest::test_suite("long")) {
    const std::vector<Drawing> drawings(45, [](const Pen& pen) {
        pen.path(200);
        pen.travel(0, 0);
        for (int i = 0; i < 700; ++i)
            pen.line(std::sin(i * i * 0.37) / 2, std::cos(i * i * 0.61) / 2);
    });
    for (const bool is_cut : {true, false}) {
        CAPTURE(is_cut);
        const std::string file = write_print("safety_cut", drawings, {}, hot());
        const auto size = std::filesystem::file_size(file);
        REQUIRE(size > 100'000);
        SimulationJob job = job_of(file);
        bool is_done = false;
        double last_s = 0;
        PrintControl control;
        End end;
        job.printer = small_printer();
        job.control = &control;
        job.heat_watch = [&](double time_s, bool any_heater_on) {
            end.is_on = any_heater_on;
            if (any_heater_on) end.last_on_s = time_s;
            last_s = time_s;
            if (is_done || time_s < 20) return;
            is_done = true;
            if (is_cut) return std::filesystem::resize_file(file, size / 3 * 2);
            std::fstream changed(file, std::ios::in | std::ios::out | std::ios::binary);
            changed.seekp(static_cast<std::streamoff>(size / 3 * 2));
            changed.write("damaged", 7);
        };
        const Result<SimulationReport> report = simulate(job);
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().status == ExitStatus::input);
        CHECK(to_string(report.error()).find("safety_cut") != std::string::npos);
        CHECK_FALSE(end.is_on);
        CHECK(end.last_on_s <= last_s);
        CHECK(control.status().is_position_known);
    }
}
