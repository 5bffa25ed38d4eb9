// Pauses and resumes that come while the one before is still under way, and what a print waits for before it goes on
// (life.h 1, 2): in simulations.

#include <doctest/doctest.h>

#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

config::Printer printer_of_turns() {
    config::Printer printer = config::generic_printer();
    printer.pause.park_mm = {{5, 120}};
    return printer;
}

SimulationReport turned(const std::string& file, const std::string& script, bool no_heat) {
    SimulationJob job{file, printer_of_turns(), {}, {}, {}};
    job.script = *parse_script(script, "script");
    job.no_heat = no_heat;
    const Result<SimulationReport> report = simulate(job);
    REQUIRE_MESSAGE(report.ok(), to_string(report.error()));
    CHECK(report->within_limits());
    return *report;
}

}  // namespace

TEST_CASE("life 2: a resume waited for a bed that was set lower to get cold") {
    const std::string file =
        write_print("set_lower", {draw_square, draw_arcs}, {}, [](format::LayerState& state) {
            state.temperatures.push_back({{format::HeaterKind::bed, 0}, 60});
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 230});
        });
    const SimulationReport plain = turned(file, "", false);
    const auto at = [&](double after_s) { return std::to_string(plain.waited_s + after_s) + ' '; };
    const auto paused_s = [&](const std::string& set) {
        const SimulationReport report = turned(
            file, at(2) + "pause\n" + at(10) + "set " + set + '\n' + at(11) + "resume\n", false);
        CHECK(report.positions == plain.positions);
        return report.paused_s;
    };
    CHECK(paused_s("bed 40") < 20);
    CHECK(paused_s("bed 0") < 20);
    CHECK(paused_s("tool 190") < 20);
    // What is too cold is waited for.
    CHECK(paused_s("bed 75") > 25);
}

TEST_CASE("life 1: a resume that came while the head still parked was refused") {
    const std::string file = write_print("turn_round", {draw_square, draw_arcs, draw_circles});
    const SimulationReport plain = turned(file, "", true);
    // While it brakes, while it parks, and after a pause that withdraws the first resume.
    for (const char* script : {"2 pause\n2.1 resume", "2 pause\n2.6 resume", "2 pause\n3 resume",
                               "2 pause\n2.1 resume\n2.2 pause\n2.3 resume"}) {
        CAPTURE(script);
        const SimulationReport report = turned(file, script, true);
        CHECK(report.positions == plain.positions);
        CHECK(report.trip_steps == plain.trip_steps);
        CHECK(report.notes.empty());
        CHECK(report.paused_s > 1);
        CHECK(report.paused_s < 8);
    }
    const SimulationReport withdrawn =
        turned(file, "2 pause\n2.1 resume\n2.2 pause\n60 resume", true);
    CHECK(withdrawn.paused_s > 55);
    CHECK(withdrawn.notes.empty());
}

TEST_CASE("life 1: a resume withdraws the pause that was to come when the head is back") {
    const std::string file = write_print("turn_again", {draw_square, draw_arcs, draw_circles});
    const SimulationReport plain = turned(file, "", true);
    const SimulationReport report =
        turned(file, "2 pause\n30 resume\n30.2 pause\n30.4 resume", true);
    CHECK(report.positions == plain.positions);
    CHECK(report.notes.empty());
    CHECK(report.paused_s < 34);
}

TEST_CASE("life 5: a filament that is still being drawn out is not pushed in again") {
    const std::string file = write_print("drawn_out", {draw_square, draw_arcs, draw_circles});
    SimulationJob job{file, printer_of_turns(), {}, {}, {}};
    job.no_heat = true;
    job.script = *parse_script("2 change_filament\n3 resume\n60 resume", "script");
    const Result<SimulationReport> report = simulate(job);
    REQUIRE(report.ok());
    REQUIRE(report->notes.size() == 1);
    CHECK(report->notes[0].message.find("still being drawn out") != std::string::npos);
}
