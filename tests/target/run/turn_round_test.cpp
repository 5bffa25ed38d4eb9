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
