// Heat in long pauses (life.h 3, heat_order.h 3), in simulations.

#include <doctest/doctest.h>

#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

std::string heated_file(const std::string& name) {
    return write_print(name, {draw_square}, {}, [](format::LayerState& state) {
        state.temperatures.push_back({bed, 60});
        state.temperatures.push_back({tool, 210});
    });
}

// Called about once a second of virtual time.
using Watch = std::function<void(double time_s, const PrintStatus& status)>;

Result<SimulationReport> simulated(const std::string& file, const std::string& script,
                                   const Watch& watch,
                                   const config::Printer& printer = config::generic_printer()) {
    SimulationJob job{file, printer, {}, {}, {}};
    job.script = *parse_script(script, "script");
    PrintControl control;
    job.control = &control;
    job.heat_watch = [&](double time_s, bool) { watch(time_s, control.status()); };
    return simulate(job);
}

}  // namespace

TEST_CASE("life 3: in a long pause the tool goes cold, and the bed holds on to the part") {
    const config::PauseSettings pause = config::generic_printer().pause;
    bool was_seen = false, bed_held = true, tool_cold = false;
    const auto report = simulated(
        heated_file("standby"), "5 pause\n2000 resume\n",
        [&](double time_s, const PrintStatus& status) {
            if (time_s < 5 + pause.tool_off_s + 300 || time_s > 1'990) return;
            was_seen = true;
            bed_held = bed_held && status.heaters[config::heater_bed].target_c == 60;
            tool_cold = tool_cold || status.heaters[config::heater_tool].temperature_c < 100;
            CHECK(status.heaters[config::heater_tool].target_c == 0);
        });
    REQUIRE_MESSAGE(report.ok(), to_string(report.error()));
    CHECK(was_seen);
    CHECK(bed_held);
    CHECK(tool_cold);
}

TEST_CASE("heat order 3: a pause with heaters on standby is no waiting for heat" *
          doctest::test_suite("long")) {
    // It goes cold before the print has had the heat that it waits for.
    config::Printer printer = config::generic_printer();
    printer.pause.tool_off_s = 30;
    const auto report = simulated(
        heated_file("standby_wait"), "5 pause\n8000 resume\n", [](double, const PrintStatus&) {},
        printer);
    REQUIRE_MESSAGE(report.ok(), to_string(report.error()));
    CHECK(report->paused_s > 7'000);
}
