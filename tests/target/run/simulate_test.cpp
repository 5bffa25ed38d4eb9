// Contract of target/run/simulate.h, by number, from file to report.

#include "target/run/simulate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "target/gpio/wave_file.h"
#include "target/run/inspect.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

SimulationReport report_of(const std::string& file,
                           const config::Printer& printer = config::generic_printer(),
                           std::optional<std::string> trace = {}) {
    Result<SimulationReport> report = simulate({file, printer, std::move(trace), {}, {}, true});
    REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : to_string(report.error())));
    return *report;
}

// Half a step, but for the nanosecond that times are rounded to.
void check_half_step(const SimulationReport& report) {
    CAPTURE(text_of(report));
    CHECK(report.within_limits());
    CHECK(report.worst_steps() < 0.5 + 1e-4);
    CHECK(report.worst_steps() > 0.4);
}

// Where the file's path ends, in steps from the start of the print.
StepPositions expected_end(const std::string& file, const config::Printer& printer) {
    Result<format::Reader> reader = format::Reader::open(file);
    REQUIRE(reader.ok());
    FilePath path(std::move(*reader), printer.start_mm, 1.75);
    PathCurve curve;
    AxisValues end{};
    for (;;) {
        const Result<bool> more = path.next(curve);
        REQUIRE(more.ok());
        if (!*more) break;
        end = curve.to_mm;
    }
    StepPositions steps{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double start = i < 3 ? printer.start_mm[i] : 0;
        steps[i] = std::llround((end[i] - start) * printer.axes[i].steps_per_mm);
    }
    return steps;
}

config::Printer coarse_printer() {
    config::Printer printer = config::generic_printer();
    printer.axes[config::axis_x].steps_per_mm = 31.7;
    printer.axes[config::axis_y].steps_per_mm = 12.5;
    printer.axes[config::axis_z].steps_per_mm = 25;
    printer.axes[config::axis_e].steps_per_mm = 9.3;
    printer.start_mm = {3.1, -2.2, 0.7};
    printer.filament_diameter_mm = 1.75;
    return printer;
}

config::Printer fine_printer() {
    config::Printer printer = config::generic_printer();
    for (std::size_t i = 0; i < 2; ++i) printer.axes[i].steps_per_mm = 640;
    printer.axes[config::axis_z].steps_per_mm = 3200;
    printer.axes[config::axis_e].steps_per_mm = 2000;
    printer.pulse = {1'000, 1'000, 200, 200, 5'000'000};
    return printer;
}

}  // namespace

TEST_CASE("simulate 2, 3: every kind of motion stays within half a microstep, turned and mirrored" *
          doctest::test_suite("long")) {
    int number = 0;
    for (const Case& what : all_cases())
        for (const bool mirrored : {false, true})
            for (const double angle_rad : {0.0, 0.3, std::numbers::pi / 2, 2.5}) {
                CAPTURE(what.name);
                CAPTURE(mirrored);
                CAPTURE(angle_rad);
                const std::string file =
                    write_print("case" + std::to_string(number++ % 4), {what.drawing, what.drawing},
                                {angle_rad, mirrored, 40, 30});
                const SimulationReport report = report_of(file);
                check_half_step(report);
                CHECK(report.positions == expected_end(file, report.printer));
                CHECK(report.totals.layers == 2);
            }
}

TEST_CASE("simulate 2, 3: on coarse and fine machines, and from another start" *
          doctest::test_suite("long")) {
    std::vector<Drawing> drawings;
    for (const Case& what : all_cases()) drawings.push_back(what.drawing);
    const std::string file = write_print("machines", drawings);
    for (const config::Printer& printer : {coarse_printer(), fine_printer()}) {
        const SimulationReport report = report_of(file, printer);
        check_half_step(report);
        CHECK(report.positions == expected_end(file, printer));
    }
}

TEST_CASE("simulate: the report's figures are those of the drawing") {
    const SimulationReport report = report_of(write_print("figures", {draw_square}));
    const PathTotals& totals = report.totals;
    CHECK(totals.extruded_mm == doctest::Approx(80));
    const double area_mm2 = (0.45 - 0.2) * 0.2 + std::numbers::pi / 4 * 0.2 * 0.2;
    const double filament_mm2 = std::numbers::pi / 4 * 1.75 * 1.75;
    CHECK(totals.filament_mm == doctest::Approx(80 * area_mm2 / filament_mm2));
    // Up 0.2, to the layer's start at (35, 25), to the square's corner at (40, 30).
    CHECK(totals.travelled_mm == doctest::Approx(0.2 + std::hypot(35, 25) + std::hypot(5, 5)));
    const auto& x = report.pulses[config::axis_x];
    CHECK(x.steps == static_cast<std::uint64_t>((40 + 20 + 20) * 80));
    CHECK(report.positions[config::axis_x] == 40 * 80);
    CHECK(x.reversals == 1);
    CHECK(report.pulses[config::axis_z].steps == 80);
    // 80 mm at 60 mm/s and 48 mm at 150 mm/s, with ramps.
    CHECK(report.print_time_s > 80 / 60.0 + 48 / 150.0);
    CHECK(report.print_time_s < 80 / 60.0 + 48 / 150.0 + 0.5);
    // 106 mm/s on x at most, on the travels.
    REQUIRE(x.shortest_interval_ns.has_value());
    CHECK(1e9 / static_cast<double>(*x.shortest_interval_ns) < 150 * 80 * 1.001);
    CHECK(json_of(report).find("\"within_half_step\":true") != std::string::npos);
    CHECK(text_of(report).find("within half a microstep everywhere") != std::string::npos);
}

TEST_CASE("simulate 4: the wave decodes to the same positions, with the driver's times kept" *
          doctest::test_suite("long")) {
    std::vector<Drawing> drawings;
    for (const Case& what : all_cases()) drawings.push_back(what.drawing);
    const std::string file = write_print("trace", drawings);
    const std::string trace = file + ".vcd";
    config::Printer printer = config::generic_printer();
    printer.axes[config::axis_x].enable = config::Pin{"gpiochip0", 22u, true};
    const SimulationReport report = report_of(file, printer, trace);
    const Wave wave = read_wave(trace);
    CHECK(wave.wires.size() == 9);
    std::map<std::string, char> level;
    std::map<std::string, std::int64_t> changed_ns;
    std::map<std::string, std::int64_t> count;
    std::size_t too_short = 0;
    const config::PulseTiming& pulse = printer.pulse;
    for (const auto& [time_ns, changes] : wave.changes) {
        for (const auto& [name, value] : changes) {
            const bool known = changed_ns.count(name) != 0;
            const std::string axis = name.substr(0, 1);
            if (time_ns > 0 && name == axis + "_step") {
                const std::int64_t least_ns = value == '1' ? pulse.low_ns : pulse.high_ns;
                too_short += known && time_ns - changed_ns[name] < least_ns;
                const std::string direction = axis + "_direction";
                if (value == '1') {
                    count[axis] += level[direction] == '1' ? 1 : -1;
                    too_short += changed_ns.count(direction) &&
                                 time_ns - changed_ns[direction] < pulse.direction_setup_ns;
                    CHECK(level["x_enable"] == '1');
                    CHECK(changes.count(direction) == 0);
                }
            }
        }
        for (const auto& [name, value] : changes) {
            level[name] = value;
            if (time_ns > 0) changed_ns[name] = time_ns;
        }
    }
    CHECK(too_short == 0);
    for (std::size_t i = 0; i < config::axis_count; ++i)
        CHECK(count[std::string(config::axis_names[i])] ==
              report.positions[i] + report.trip_steps[i]);
    for (const auto& [name, value] : level) CHECK(value == '0');
    // With the head lifted at its end.
    const double lifting_s = static_cast<double>(wave.end_ns) / 1e9 - report.print_time_s;
    CHECK(lifting_s > 0);
    CHECK(lifting_s < 1);
    std::filesystem::remove(trace);
}

TEST_CASE(
    "simulate 4: an unwritable trace is an error, and a failed simulation leaves none behind") {
    const std::string file = write_print("unwritable", {draw_square});
    const auto failed =
        simulate({file, config::generic_printer(), "/nonexistent/out.vcd", {}, {}, true});
    REQUIRE_FALSE(failed.ok());
    CHECK(failed.error().status == ExitStatus::output);
    const std::string trace = file + ".stopped.vcd";
    const auto stopped =
        simulate({file, config::generic_printer(), trace, {}, [] { return true; }, true});
    REQUIRE_FALSE(stopped.ok());
    CHECK(stopped.error().status == ExitStatus::stopped);
    CHECK_FALSE(std::filesystem::exists(trace));
}

TEST_CASE("simulate: without a trace nothing but the report differs from a run with one") {
    const std::string file = write_print("same", {draw_arcs});
    const std::string trace = file + ".vcd";
    const SimulationReport with = report_of(file, config::generic_printer(), trace);
    const SimulationReport without = report_of(file);
    CHECK(json_of(with) == json_of(without));
    std::filesystem::remove(trace);
}

TEST_CASE(
    "simulate: temperatures, fans and pauses are passed over with a note each, if they must") {
    const Drawing drawing = [](const Pen& pen) {
        pen.layer.temperature({format::HeaterKind::tool, 0}, 230, true);
        pen.layer.fan(0, 0.5);
        draw_square(pen);
        pen.layer.pause(format::PauseReason::user);
    };
    const std::string file = write_print("notes", {drawing});
    const Result<SimulationReport> report =
        simulate({file, config::generic_printer(), {}, {}, {}, true});
    REQUIRE(report.ok());
    const std::string json = json_of(*report);
    CHECK(json.find("tool 0 to 230") != std::string::npos);
    CHECK(json.find("fans") != std::string::npos);
    CHECK(json.find("pauses") != std::string::npos);
}

TEST_CASE("simulate: a distance that is infinite is null in JSON, which has no number for it") {
    SimulationReport report =
        report_of(write_print("null", {draw_square}), config::generic_printer());
    report.planned_steps[1] = report.path.distance_mm = std::numeric_limits<double>::infinity();
    const std::string json = json_of(report);
    CHECK(json.find("inf") == std::string::npos);
    CHECK(json.find("\"deviation_mm\":null,\"within_half_step\":false") != std::string::npos);
    CHECK(json.find("\"off_plan_steps\":null}") != std::string::npos);
}

TEST_CASE(
    "simulate: drivers that are slow to turn delay everything alike, and the path keeps its "
    "shape") {
    config::Printer printer = config::generic_printer();
    printer.pulse.direction_setup_ns = 4'000'000;
    printer.pulse.direction_hold_ns = 4'000'000;
    const SimulationReport report = report_of(write_print("slow_turn", {draw_circles}), printer);
    CHECK(report.delayed_ns > 0);
    check_half_step(report);
}

TEST_CASE("inspect 2: a path that leaves the range is refused, between the ends of an arc too") {
    const std::string file = write_print("range", {draw_square, [](const Pen& pen) {
                                                       pen.path();
                                                       pen.travel(0, 0);
                                                       pen.arc(20, 0, 12);  // down to y = 18
                                                   }});
    config::Printer printer = config::generic_printer();
    printer.axes[config::axis_y].min_mm = 18;
    printer.start_mm = {20, 20, 0};
    CHECK(inspect(file, printer).ok());
    printer.axes[config::axis_y].min_mm = 18.01;
    const Result<Inspection> refused = inspect(file, printer);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::machine);
    CHECK(refused.error().message.find("18.000 mm on axis y") != std::string::npos);
    CHECK(refused.error().where.layer == 2);
}

TEST_CASE("inspect 1: a file cut anywhere is refused before anything moves") {
    const std::string file = write_print("cut", {draw_square, draw_arcs, draw_hatch});
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    const std::string cut = file + ".cut";
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97) {
        std::ofstream(cut, std::ios::binary)
            .write(bytes.data(), static_cast<std::streamsize>(size));
        const Result<Inspection> refused = inspect(cut, config::generic_printer());
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().status == ExitStatus::input);
    }
    std::filesystem::remove(cut);
}

TEST_CASE("inspect 2: a second tool is refused as not supported") {
    const std::string file = write_print("tool", {[](const Pen& pen) {
                                             pen.layer.tool(1);
                                             draw_square(pen);
                                         }});
    const Result<Inspection> refused = inspect(file, config::generic_printer());
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::unsupported);
}

TEST_CASE("simulate: progress tells the time that the file states for the whole print") {
    for (const double stated_s : {0.0, 12.5}) {
        const std::string file =
            write_print("stated_time", {draw_square, draw_square}, {},
                        [&](format::LayerState& state) { state.estimated_time_s = stated_s / 2; });
        std::vector<Progress> told;
        const Result<SimulationReport> report =
            simulate({file,
                      config::generic_printer(),
                      {},
                      [&](const Progress& progress) { told.push_back(progress); },
                      {},
                      true});
        REQUIRE(report.ok());
        REQUIRE(!told.empty());
        for (const Progress& progress : told) {
            CHECK(progress.estimated_s == stated_s);
            CHECK(progress.layers == 2);
        }
    }
}
