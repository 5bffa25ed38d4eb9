// What life.h (4, 7) and course.h (4) say of the end of the path: in simulations and in real time.

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "target/gpio/mock_chip.h"
#include "target/gpio/wave_file.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr double last_layer_mm = 0.4;
constexpr gpio::LineMask z_step = step_bit(config::axis_z);

struct Finished {
    SimulationReport report;
    PrintStatus status;
};

void draw_end_stroke(const Pen& pen) {
    pen.path(80);
    pen.travel(0, 0);
    pen.line(4, 0);
}

const std::string& short_file() {
    static const std::string file = write_print("finish", {draw_square, draw_wipes});
    return file;
}

Finished finished(const config::Printer& printer, const std::string& file = short_file(),
                  const std::string& script = "", bool no_heat = true) {
    PrintControl control;
    SimulationJob job{file, printer, {}, {}, {}};
    job.no_heat = no_heat;
    job.control = &control;
    job.script = *parse_script(script, "script");
    const Result<SimulationReport> report = simulate(job);
    REQUIRE_MESSAGE(report.ok(), to_string(report.error()));
    CHECK(report->within_limits());
    const PrintStatus status = control.status();
    CHECK(status.state == PrintState::done);
    CHECK(status.is_position_known);
    return {*report, status};
}

std::int64_t steps(const config::Printer& printer, std::size_t axis, double mm) {
    return std::llround(mm * printer.axes[axis].steps_per_mm);
}

}  // namespace

TEST_CASE("life 4: a print that was done left its hot nozzle on the part") {
    config::Printer belts = parking_printer(), delta = parking_printer();
    belts.kinematics = config::Kinematics::corexy;
    delta.kinematics = config::Kinematics::delta;
    delta.delta = {{250, 250, 250}, {120, 120, 120}, {210, 330, 90}, 120};
    delta.pause.park_mm = {{-40, 60}};
    for (const config::Printer& printer : {parking_printer(), belts, delta}) {
        const auto [report, status] = finished(printer);
        const auto& [x_mm, y_mm] = *printer.pause.park_mm;
        CHECK(std::abs(status.position_mm[0] - x_mm) < 0.05);
        CHECK(std::abs(status.position_mm[1] - y_mm) < 0.05);
        CHECK(std::abs(status.position_mm[2] - last_layer_mm - printer.pause.lift_mm) < 0.02);
        const std::int64_t drawn_back = steps(printer, config::axis_e, -printer.pause.retract_mm);
        CHECK(std::abs(report.trip_steps[config::axis_e] - drawn_back) <= 1);
    }
}

TEST_CASE("life 4: without a place to park the head is lifted, as far as its axis lets it") {
    config::Printer printer = config::generic_printer();
    for (const double highest_mm : {200.0, 2.0, last_layer_mm + 0.4}) {
        printer.axes[config::axis_z].max_mm = highest_mm;
        const auto [report, status] = finished(printer);
        const double lift_mm = std::min(printer.pause.lift_mm, highest_mm - last_layer_mm);
        CHECK(report.trip_steps[config::axis_x] == 0);
        CHECK(report.trip_steps[config::axis_y] == 0);
        CHECK(std::abs(report.trip_steps[config::axis_z] -
                       steps(printer, config::axis_z, lift_mm)) <= 1);
    }
}

TEST_CASE("life 4: the path to its end is the same, and a file that has gone away itself is well") {
    config::Printer still = config::generic_printer();
    still.pause.lift_mm = still.pause.retract_mm = 0;
    const auto [report, status] = finished(still);
    CHECK(report.trip_steps == StepPositions{});
    const Finished parked = finished(parking_printer());
    CHECK(parked.report.positions == report.positions);
    CHECK(parked.report.writes == report.writes);
    CHECK(parked.report.print_time_s == report.print_time_s);
    config::Printer low = parking_printer();
    low.axes[config::axis_z].max_mm = 50;
    const std::string away = write_print("gone_away", {[](const Pen& pen) {
                                             draw_square(pen);
                                             pen.layer.retract();
                                             pen.layer.travel_to(20, 20, 50);
                                             pen.layer.travel_to(5, 120, 50);
                                         }});
    const Finished gone = finished(low, away);
    for (std::size_t i = 0; i < 3; ++i) CHECK(gone.report.trip_steps[i] == 0);
}

TEST_CASE("life 4: a nozzle that the file has let go cold pushes nothing at the end") {
    config::Printer printer = parking_printer();
    const auto heats = [](format::LayerState& state) {
        state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
    };
    const std::string file =
        write_print("cold_end", {[](const Pen& pen) {
                        draw_square(pen);
                        pen.layer.retract();
                        pen.layer.temperature({format::HeaterKind::tool, 0}, 0, false);
                        pen.layer.travel_to(25, 25);
                        // For the nozzle to get cold.
                        for (int i = 0; i < 10; ++i) pen.layer.dwell(60'000);
                        pen.layer.travel_to(30, 30);
                    }},
                    {}, heats);
    const Finished cold = finished(printer, file, "", false);
    CHECK(cold.report.trip_steps[config::axis_e] == 0);
    CHECK(cold.report.trip_steps[config::axis_z] > 0);
}

TEST_CASE("life 4: what is asked for while the head parks at the end comes too late") {
    const double end_s = finished(parking_printer()).report.print_time_s;
    for (const char* command : {"pause", "cancel", "change_filament", "resume"}) {
        CAPTURE(command);
        const std::string script = std::to_string(end_s + 0.3) + ' ' + command;
        const auto [report, status] = finished(parking_printer(), short_file(), script);
        REQUIRE(report.notes.size() == 1);
        CHECK(report.notes[0].message.find("refused `" + std::string(command)) !=
              std::string::npos);
        CHECK(std::abs(status.position_mm[1] - 120) < 0.05);
    }
}

TEST_CASE("life 4: a pause that comes too late to rest before the end does not keep the print") {
    const double end_s = finished(parking_printer()).report.print_time_s;
    for (const double before_s : {0.05, 0.2}) {
        const auto [report, status] =
            finished(parking_printer(), short_file(),
                     std::to_string(end_s - before_s) + " pause\n60 resume");
        CHECK(std::abs(status.position_mm[1] - 120) < 0.05);
    }
}

TEST_CASE("life 4: a pause withdrawn just before the end was told as a resume that is refused") {
    const double end_s = finished(parking_printer()).report.print_time_s;
    const std::string script =
        std::to_string(end_s - 0.05) + " pause\n" + std::to_string(end_s - 0.03) + " resume";
    const auto [report, status] = finished(parking_printer(), short_file(), script);
    CHECK(status.message == "");
    CHECK(report.notes.size() == finished(parking_printer()).report.notes.size());
}

TEST_CASE("print 5: the way to the park place is that of the simulation, step by step") {
    config::Printer printer = nearby_printer();
    printer.pause.park_mm = {{36, 26}};
    const std::string file = write_print("same_way", {draw_end_stroke});
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(8, clock, gpio::recorder(writes));
    REQUIRE(print({file, printer, true, {}}, chip, clock).ok());
    const std::string trace = file + ".vcd";
    const SimulationJob job{file, printer, trace, {}, {}, true};
    REQUIRE(simulate(job).ok());
    const Wave wave = read_wave(trace);
    std::filesystem::remove(trace);
    // Which lines are high, write by write.
    std::vector<std::string> printed, simulated;
    const std::vector<std::string> names = line_layout(printer).names;
    const auto add = [](std::vector<std::string>& all, const std::string& high) {
        if (all.empty() ? !high.empty() : all.back() != high) all.push_back(high);
    };
    for (const gpio::LineWrite& write : writes) {
        std::string high;
        for (std::size_t i = 0; i < names.size(); ++i) high += write.levels >> i & 1 ? '1' : '0';
        add(printed, high);
    }
    std::string high(names.size(), '0');
    for (const auto& [time_ns, changes] : wave.changes) {
        for (const auto& [name, level] : changes)
            for (std::size_t i = 0; i < names.size(); ++i) {
                std::string wire = names[i];
                std::replace(wire.begin(), wire.end(), '.', '_');
                if (wire == name) high[i] = level;
            }
        add(simulated, high);
    }
    REQUIRE(printed.size() > 1000);
    CHECK((printed == simulated));
}

TEST_CASE("print 7, life 7: a cut while the head parked at the end offered to resume the part") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("parking_cut", {draw_end_stroke});
    for (const bool is_stopped : {false, true}) {
        CAPTURE(is_stopped);
        gpio::MonotonicClock clock;
        PrintJob job{file, printer, true, {}};
        job.journal = file + ".journal";
        bool had_journal = false, has_journal = false;
        gpio::LineMask before = 0;
        std::int64_t z_steps = 0;
        gpio::MockChip chip(8, clock, [&](const gpio::LineWrite& write) {
            if (~before & write.levels & z_step) {
                if (++z_steps == 1) had_journal = std::filesystem::exists(job.journal);
                has_journal = std::filesystem::exists(job.journal);
                const std::int64_t layer = steps(printer, config::axis_z, 0.2);
                if (is_stopped && z_steps == layer + 10) ::kill(::getpid(), SIGTERM);
            }
            before = write.levels;
        });
        const Result<PrintReport> report = print(job, chip, clock);
        CHECK(report.ok() == !is_stopped);
        CHECK(had_journal);
        CHECK_FALSE(has_journal);
        CHECK_FALSE(std::filesystem::exists(job.journal));
        if (!is_stopped) CHECK(z_steps == steps(printer, config::axis_z, 0.2 + 0.3));
        CHECK(chip.levels() == 0);
    }
}
