// Contract of target/run/line_layout.h, by number, and what the report makes of faults.

#include "target/run/line_layout.h"

#include <doctest/doctest.h>

#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;

TEST_CASE("layout 1, 2: steps and directions by axis, then the enable lines that there are") {
    const Result<config::Printer> printer =
        config::read_printer(std::string(LYR_FIXTURES) + "/printers/cartesian.toml");
    REQUIRE(printer.ok());
    const LineLayout layout = line_layout(*printer);
    REQUIRE(layout.names.size() == 9);
    CHECK(layout.names[0] == "x.step");
    CHECK(layout.names[3] == "y.direction");
    CHECK(layout.names[8] == "x.enable");
    CHECK(layout.enable == gpio::line_bit(8));
    const auto requests = line_requests(*printer);
    REQUIRE(requests.ok());
    REQUIRE(requests->size() == layout.names.size());
    for (std::size_t i = 0; i < layout.names.size(); ++i)
        CHECK((*requests)[i].purpose == "axis." + layout.names[i]);
    // y is inverted, and enable is active low.
    CHECK((*requests)[3].active_low);
    CHECK_FALSE((*requests)[1].active_low);
    CHECK((*requests)[8].active_low);
    CHECK((*requests)[0].drive == gpio::Drive::push_pull);
    const config::Pin open{"gpiochip1", 3u, true, true};
    CHECK(line_request("e.step", open).drive == gpio::Drive::open_drain);
    CHECK_FALSE(line_request("e.step", open, true).active_low);
}

TEST_CASE("layout 3: a line that is missing is named by its key") {
    Result<config::Printer> printer =
        config::read_printer(std::string(LYR_FIXTURES) + "/printers/cantilever.toml");
    REQUIRE(printer.ok());
    CHECK(line_requests(*printer).ok());
    printer->axes[config::axis_z].direction.reset();
    const auto requests = line_requests(*printer);
    REQUIRE_FALSE(requests.ok());
    CHECK(requests.error().status == ExitStatus::machine);
    CHECK(requests.error().message.find("axis.z.direction") != std::string::npos);
}

TEST_CASE("simulate 3: deviation, short pulses and figures that are no numbers fail the report") {
    SimulationReport good;
    good.printer = config::generic_printer();
    good.path.steps = good.planned_steps = {0.5, 0.5, 0.5, 0.5};
    good.pulses[0].shortest_high_ns = 2'000;
    CHECK(good.within_limits());
    SimulationReport bad = good;
    bad.path.steps[1] = 0.501;
    CHECK_FALSE(bad.within_limits());
    bad = good;
    bad.planned_steps[3] = 0.6;
    CHECK_FALSE(bad.within_limits());
    CHECK(bad.worst_steps() == 0.6);
    bad = good;
    bad.planned_steps[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(bad.within_limits());
    bad = good;
    bad.pulses[0].shortest_high_ns = 1'999;
    CHECK_FALSE(bad.within_limits());
    bad = good;
    bad.pulses[2].shortest_setup_ns = 999;
    CHECK_FALSE(bad.within_limits());
}

TEST_CASE(
    "simulate 3: the limit is half a step, a nanosecond at full speed and a millionth of a step") {
    SimulationReport report;
    report.printer = config::generic_printer();
    for (std::size_t i = 0; i < config::axis_count; ++i) {
        const config::Axis& axis = report.printer.axes[i];
        const double limit = 0.5 + axis.max_speed_mm_s * axis.steps_per_mm * 1e-9 + 1e-6;
        for (AxisValues* steps : {&report.path.steps, &report.planned_steps}) {
            (*steps)[i] = limit - 1e-9;
            CHECK(report.within_limits());
            (*steps)[i] = limit + 1e-9;
            CHECK_FALSE(report.within_limits());
            (*steps)[i] = 0.5;
        }
    }
}

TEST_CASE("report: names with quotes and control characters are JSON all the same") {
    SimulationReport report;
    report.file = "a\"b\\c\n.lyr";
    const std::string json = json_of(report);
    CHECK(json.find(R"("file":"a\"b\\c\u000a.lyr")") != std::string::npos);
    CHECK(std::count(json.begin(), json.end(), '\n') == 1);
}
