// Heat in prints, from the file to the lines: contracts of target/run/heat_order.h, demands.h, heating.h, and what
// executor.h, simulate.h and print.h say of it, by number.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/run/demands.h"
#include "target/run/event_stream.h"
#include "target/run/executor.h"
#include "target/run/print.h"
#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr format::Heater chamber{format::HeaterKind::chamber, 0};

Result<SimulationReport> simulated_with_faults(
    const std::string& file, const std::string& script = "",
    config::Printer printer = config::generic_printer()) {
    const auto faults = thermal::parse_faults(script, "faults", printer);
    REQUIRE(faults.ok());
    SimulationJob job{file, std::move(printer), {}, {}, {}};
    job.faults = *faults;
    return simulate(job);
}

Diagnostics refused_of(const std::string& file, const config::Printer& printer) {
    const Result<Inspection> inspection = inspect(file, printer);
    REQUIRE(inspection.ok());
    Diagnostics notes;
    const Status possible = check_demands(*inspection, printer, false, notes);
    if (possible) return {};
    return {possible.error()};
}

void check_refused(const std::string& file, const config::Printer& printer, const char* part) {
    const Diagnostics refused = refused_of(file, printer);
    REQUIRE(refused.size() == 1);
    CHECK(refused[0].status == ExitStatus::machine);
    CHECK_MESSAGE(refused[0].message.find(part) != std::string::npos, refused[0].message);
    CHECK(refused[0].message.find("--no-heat") != std::string::npos);
}

}  // namespace

TEST_CASE(
    "heat order: a layer's start waits at the begin of a print and orders only changes later") {
    HeatOrders orders;
    format::LayerState layer;
    layer.temperatures.push_back({bed, 60});
    layer.temperatures.push_back({tool, 210});
    layer.fans.push_back({0, 0.0});
    const format::Operation start = format::LayerStart{};
    const auto first = orders.take(start, layer);
    REQUIRE(first);
    CHECK(first->is_gate());
    CHECK(first->targets_c[config::heater_tool] == 210);
    CHECK(first->targets_c[config::heater_bed] == 60);
    CHECK_FALSE(first->targets_c[config::heater_chamber]);
    CHECK_FALSE(first->fan_duty);
    CHECK_FALSE(orders.take(start, layer));
    const auto fan = orders.take(format::Fan{0, 0.5}, layer);
    REQUIRE(fan);
    CHECK(fan->fan_duty == 0.5);
    CHECK_FALSE(fan->is_gate());
    CHECK_FALSE(orders.take(format::Fan{0, 0.5}, layer));
    CHECK_FALSE(orders.take(format::Fan{3, 1}, layer));
    CHECK_FALSE(orders.take(format::Temperature{tool, 210, false}, layer));
    const auto again = orders.take(format::Temperature{tool, 210, true}, layer);
    REQUIRE(again);
    CHECK(again->is_gate());
    const auto off = orders.take(format::Temperature{tool, 0, true}, layer);
    REQUIRE(off);
    CHECK_FALSE(off->is_gate());
    CHECK_FALSE(orders.take(format::Temperature{{format::HeaterKind::tool, 1}, 200, true}, layer));
}

TEST_CASE("demands 1: what the machine cannot heat, or pushes cold, is refused with its key") {
    const config::Printer printer = config::generic_printer();
    const std::string good =
        write_print("heat_good", {draw_square, draw_arcs}, {}, heated(210, 60));
    CHECK(refused_of(good, printer).empty());
    check_refused(write_print("heat_chamber", {draw_square}, {},
                              [](format::LayerState& state) {
                                  state.temperatures.push_back({tool, 210});
                                  state.temperatures.push_back({chamber, 50});
                              }),
                  printer, "the chamber");
    check_refused(write_print("heat_hot", {draw_square}, {}, heated(272, 60)), printer,
                  "heater.tool.range_c");
    check_refused(write_print("heat_bed", {draw_square}, {}, heated(210, 126)), printer,
                  "heater.bed.range_c");
    check_refused(write_print("heat_low", {draw_square}, {}, heated(165, 60)), printer,
                  "min_extrude_c");
    check_refused(write_print("heat_none", {draw_square}), printer, "min_extrude_c");
    // Switched off, or lowered, in the middle of a layer, and raised without a wait.
    for (const double lowered_c : {0.0, 150.0}) {
        const std::string file = write_print("heat_lowered",
                                             {draw_square,
                                              [&](const Pen& pen) {
                                                  pen.layer.temperature(tool, lowered_c, false);
                                                  draw_square(pen);
                                              }},
                                             {}, heated(210, 60));
        check_refused(file, printer, "min_extrude_c");
        CHECK(refused_of(file, printer)[0].where.layer == 2);
    }
    // Pushing back what was drawn back is pushing, too.
    check_refused(write_print("heat_unretract", {[](const Pen& pen) {
                                  draw_square(pen);
                                  pen.layer.retract();
                                  pen.layer.temperature(tool, 0, false);
                                  pen.layer.unretract();
                              }},
                              {}, heated(210, 60)),
                  printer, "min_extrude_c");
    const auto raised = [](bool wait) {
        return write_print("heat_raised", {[&](const Pen& pen) {
                               pen.layer.temperature(tool, 200, wait);
                               draw_square(pen);
                           }});
    };
    check_refused(raised(false), printer, "min_extrude_c");
    CHECK(refused_of(raised(true), printer).empty());
    config::Printer cold = printer;
    cold.heaters[config::heater_tool].reset();
    CHECK(refused_of(write_print("heat_none", {draw_square}), cold).empty());
}

TEST_CASE(
    "simulate 4: a print heats first, holds while it prints, and its path is the cold one's") {
    const std::string file = write_print(
        "heat_print", {draw_square, draw_arcs, draw_circles, draw_wipes}, {}, heated(210, 60));
    const Result<SimulationReport> hot = simulated_with_faults(file);
    REQUIRE_MESSAGE(hot.ok(), message_of(hot));
    CHECK(hot->notes.empty());
    CHECK(hot->within_limits());
    CHECK(hot->waited_s > 60);
    CHECK(hot->waited_s < 300);
    REQUIRE(hot->heat.size() == 2);
    CHECK(hot->heat[0].heater == config::heater_tool);
    CHECK(std::abs(hot->heat[0].highest_c - 210) < 4);
    CHECK(std::abs(hot->heat[1].highest_c - 60) < 3);
    const Result<SimulationReport> cold =
        simulate({file, config::generic_printer(), {}, {}, {}, true});
    REQUIRE(cold.ok());
    CHECK(cold->heat.empty());
    CHECK(cold->waited_s == 0);
    CHECK(cold->positions == hot->positions);
    // The stop at the gate costs nothing where the print begins.
    CHECK(cold->print_time_s == doctest::Approx(hot->print_time_s));
    for (std::size_t i = 0; i < config::axis_count; ++i)
        CHECK(cold->pulses[i].steps == hot->pulses[i].steps);
    CHECK(text_of(*hot).find("waiting for temperatures") != std::string::npos);
    CHECK(json_of(*hot).find("\"heaters\":{\"tool\":{\"highest_c\":") != std::string::npos);
}

TEST_CASE("executor 7: waits in the middle of a layer bring the head to rest, and the path stays") {
    const auto step = [](double target_c, bool wait) {
        return [=](const Pen& pen) {
            pen.path(100);
            pen.travel(0, 0);
            pen.line(10, 0);
            pen.layer.temperature(tool, target_c, wait);
            pen.layer.fan(0, target_c > 220 ? 1 : 0.3);
            pen.line(20, 0);
            pen.arc(20, 10, 3);
            pen.line(0, 0);
        };
    };
    const std::vector<Drawing> waits{step(230, true), step(200, true), step(210, true)};
    const std::vector<Drawing> none{step(230, false), step(200, false), step(210, false)};
    const Result<SimulationReport> waited =
        simulated_with_faults(write_print("heat_waits", waits, {}, heated(205, 50)));
    const Result<SimulationReport> flying =
        simulated_with_faults(write_print("heat_none", none, {}, heated(205, 50)));
    REQUIRE_MESSAGE(waited.ok(), message_of(waited));
    REQUIRE_MESSAGE(flying.ok(), message_of(flying));
    CHECK(waited->within_limits());
    CHECK(flying->within_limits());
    CHECK(waited->positions == flying->positions);
    CHECK(waited->waited_s > flying->waited_s + 15);
    // Coming to rest on the way takes time; changing a fan or a target does not.
    CHECK(waited->print_time_s > flying->print_time_s);
    CHECK(waited->heat[0].highest_c > 227);
    const Result<SimulationReport> cold =
        simulate({write_print("heat_none", none, {}, heated(205, 50)),
                  config::generic_printer(),
                  {},
                  {},
                  {},
                  true});
    REQUIRE(cold.ok());
    CHECK(cold->print_time_s == doctest::Approx(flying->print_time_s));
}

TEST_CASE("step stream 2: orders between two moves are one, and memory does not grow with them") {
    const auto storm = [](bool wait) {
        return write_print("heat_storm", {[=](const Pen& pen) {
                               pen.path();
                               pen.travel(0, 0);
                               for (int i = 0; i < 9'000; ++i) {
                                   pen.layer.fan(0, i % 2 ? 0.2 : 0.4);
                                   pen.layer.temperature(tool, i % 2 ? 205 : 206, wait);
                               }
                               pen.line(5, 0);
                           }},
                           {}, heated(210, 60));
    };
    const Result<SimulationReport> flies = simulated_with_faults(storm(false));
    CHECK_MESSAGE(flies.ok(), message_of(flies));
    const Result<SimulationReport> refused = simulated_with_faults(storm(true));
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::input);
    HeatOrder order, next;
    order.targets_c[config::heater_bed] = 60;
    order.fan_duty = 0.1;
    next.targets_c[config::heater_tool] = 210;
    next.waits[config::heater_tool] = true;
    REQUIRE(join(order, next));
    CHECK(order.targets_c[config::heater_bed] == 60);
    CHECK(order.targets_c[config::heater_tool] == 210);
    CHECK(order.fan_duty == 0.1);
    CHECK(order.is_gate());
    CHECK_FALSE(join(order, next));
}

TEST_CASE(
    "step stream 5: an order before a dwell took effect after it, and a dwell at the end was "
    "dropped") {
    const std::string file = write_print("dwells", {[](const Pen& pen) {
                                             draw_square(pen);
                                             pen.layer.fan(0, 0.5);
                                             pen.layer.dwell(2'000);
                                             pen.layer.fan(0, 0.7);
                                             pen.layer.dwell(1'000);
                                             pen.line(9, 0);
                                             pen.layer.fan(0, 0.2);
                                             pen.layer.dwell(3'000);
                                         }});
    config::Printer plain = config::generic_printer(), shaped = plain;
    shaped.pressure_advance_s = 0.04;
    for (const config::Printer& printer : {plain, shaped}) {
        OrderQueue orders({true, false});
        auto stream = StepStream::open(file, printer, 1.75, &orders);
        REQUIRE(stream.ok());
        std::vector<Step> steps;
        for (bool more = true; more;) {
            const auto next = stream->next(steps);
            REQUIRE(next.ok());
            more = *next;
        }
        CHECK(std::is_sorted(steps.begin(), steps.end(),
                             [](const Step& a, const Step& b) { return a.time_ns < b.time_ns; }));
        // How long nothing steps before and after each order, to a millisecond.
        std::vector<std::int64_t> before_ms, after_ms;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i].axis != mark_axis) continue;
            const std::int64_t end_ns =
                i + 1 < steps.size() ? steps[i + 1].time_ns : stream->time_ns();
            before_ms.push_back((steps[i].time_ns - steps[i - 1].time_ns + 500'000) / 1'000'000);
            after_ms.push_back((end_ns - steps[i].time_ns + 500'000) / 1'000'000);
        }
        REQUIRE(after_ms.size() == 3);
        const std::array<std::int64_t, 3> rests_ms{2'000, 1'000, 3'000};
        // The first and the last step are some way from the corners; what lags takes as long again.
        constexpr std::int64_t slack_ms = 60;
        CHECK(before_ms[0] <= slack_ms);
        CHECK(std::abs(before_ms[1] - 2'000) <= slack_ms);
        CHECK(before_ms[2] <= slack_ms);
        for (std::size_t i = 0; i < rests_ms.size(); ++i)
            CHECK(std::abs(after_ms[i] - rests_ms[i]) <= slack_ms);
    }
}

TEST_CASE("step stream: a print of centuries overflowed its clock") {
    const std::string file = write_print("centuries", {[](const Pen& pen) {
                                             draw_square(pen);
                                             for (int i = 0; i < 10'000; ++i)
                                                 pen.layer.dwell(4'000'000'000);
                                             pen.line(9, 0);
                                         }});
    auto stream = StepStream::open(file, config::generic_printer(), 1.75);
    REQUIRE(stream.ok());
    std::vector<Step> steps;
    Result<bool> next = true;
    while (next && *next) next = stream->next(steps);
    REQUIRE_FALSE(next.ok());
    CHECK(next.error().status == ExitStatus::input);
    CHECK(next.error().message.find("three years") != std::string::npos);
}

TEST_CASE(
    "simulate 4: a guard that fires ends the print with its message, its time and its layer") {
    const std::string file =
        write_print("heat_faults", std::vector<Drawing>(12, draw_square), {}, heated(210, 60));
    for (const auto& [script, part] :
         {std::pair{"20 open tool", "broken wire"}, std::pair{"160 short bed", "short circuit"},
          std::pair{"0 no_power bed", "less than 2 °C"},
          std::pair{"165 jump tool 50", "no heater does"}, std::pair{"10 silent", "silent"}}) {
        CAPTURE(script);
        const Result<SimulationReport> report = simulated_with_faults(file, script);
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().status == ExitStatus::machine);
        CHECK_MESSAGE(report.error().message.find(part) != std::string::npos,
                      report.error().message);
        CHECK(report.error().message.find("after ") == 0);
        CHECK(report.error().message.find("all heaters are off") != std::string::npos);
    }
    // What breaks after the print is over is no matter.
    CHECK(simulated_with_faults(file, "1e6 open tool").ok());
}

TEST_CASE("heat order 3: a wait that has no end ends with all heaters off") {
    const std::string file = write_print("heat_forever", {draw_square}, {}, heated(210, 60));
    // Just too weak: within what this one may stray, and never there.
    config::Printer loose = config::generic_printer();
    loose.heaters[config::heater_tool]->guard.stray_c = 30;
    const Result<SimulationReport> weak = simulated_with_faults(file, "0 weak tool 0.455", loose);
    REQUIRE_FALSE(weak.ok());
    CHECK(weak.error().status == ExitStatus::machine);
    CHECK_MESSAGE(
        weak.error().message.find("after an hour of waiting for 210") != std::string::npos,
        weak.error().message);
    // Colder than the room.
    const Result<SimulationReport> cold =
        simulated_with_faults(write_print("heat_cooler",
                                          {draw_square,
                                           [](const Pen& pen) {
                                               pen.layer.temperature(bed, 10, true);
                                               draw_square(pen);
                                           }},
                                          {}, heated(210, 60)));
    REQUIRE_FALSE(cold.ok());
    CHECK_MESSAGE(cold.error().message.find("heater bed") != std::string::npos,
                  cold.error().message);
}

TEST_CASE("simulate 4: what a print is refused for was simulated cold, with a warning or none") {
    const config::Printer printer = config::generic_printer();
    config::Printer no_bed = printer;
    no_bed.heaters[config::heater_bed].reset();
    const auto check_refused = [](const std::string& file, const config::Printer& on,
                                  const char* part) {
        const Result<SimulationReport> refused = simulated_with_faults(file, "", on);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().status == ExitStatus::machine);
        CHECK_MESSAGE(refused.error().message.find(part) != std::string::npos,
                      refused.error().message);
        CHECK(simulate({file, on, {}, {}, {}, true}).ok());
    };
    check_refused(write_print("heat_no_bed", {draw_square}, {}, heated(210, 60)), no_bed,
                  "no heater for the bed");
    check_refused(write_print("heat_too_hot", {draw_square}, {}, heated(272, 60)), printer,
                  "heater.tool.range_c");
    check_refused(write_print("heat_too_cold", {draw_square}, {}, heated(100, 60)), printer,
                  "min_extrude_c");
    // It says nothing of heat at all.
    check_refused(write_print("heat_never", {draw_square}), printer, "min_extrude_c");
}

TEST_CASE("executor 7: a gate holds events back until its order is done, and leaves on request") {
    PulseSchedule schedule(config::PulseTiming{}, 0);
    std::vector<LineEvent> events;
    const std::vector<Step> steps{{1'000'000, 0, true},
                                  {1'000'000, mark_axis, false},
                                  {2'000'000, 0, true},
                                  {2'000'100, mark_axis, true},
                                  {2'000'200, 0, true}};
    schedule.append(steps, events);
    schedule.finish(2'100'000, events);
    for (const bool stops : {false, true}) {
        gpio::VirtualClock virtual_clock;
        Marks marks;
        StopRequests stop{0};
        // Done half a second after the gate is reached, or never.
        struct Waker final : gpio::Clock {
            gpio::VirtualClock& inner;
            Marks& marks;
            StopRequests& stop;
            bool stops;
            Waker(gpio::VirtualClock& c, Marks& m, StopRequests& s, bool b)
                : inner(c), marks(m), stop(s), stops(b) {}
            std::int64_t now_ns() const override { return inner.now_ns(); }
            std::int64_t wait_until_ns(std::int64_t time_ns) override {
                const std::int64_t now = inner.wait_until_ns(time_ns);
                if (now > 500'000'000 && stops) ++stop;
                if (now > 500'000'000 && !stops) marks.done = marks.reached.load();
                return now;
            }
        } clock(virtual_clock, marks, stop, stops);
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(8, clock, gpio::recorder(writes));
        Executor executor(chip, clock, {3'000, 5'000'000, 60'000'000}, stop, &marks);
        const Result<bool> executed = executor.execute(events);
        REQUIRE(executed.ok());
        CHECK(*executed == !stops);
        CHECK(marks.reached == 2);
        CHECK(executor.worst_late_ns() == 0);
        std::size_t rises = 0;
        std::int64_t last_rise_ns = 0;
        gpio::LineMask before = 0;
        for (const gpio::LineWrite& write : writes) {
            if (write.levels & ~before & step_bit(0)) ++rises, last_rise_ns = write.time_ns;
            // Nothing is out while the motion waits.
            if (write.time_ns < 400'000'000 && &write == &writes.back())
                CHECK((write.levels & all_step_bits) == 0);
            CHECK((write.changed & all_mark_bits) == 0);
            before = write.levels;
        }
        CHECK(rises == (stops ? 2 : 3));
        if (!stops) CHECK(last_rise_ns > 500'000'000);
        if (!stops) CHECK(executor.waited_ns() > 490'000'000);
        if (!stops) CHECK(executor.stretched_ns() == 0);
    }
}

namespace {

// A real print's threads on mock lines, whose sensors read 26 °C until one breaks.
struct Board {
    config::Printer printer = config::generic_printer();
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes, heat_writes;
    gpio::MockChip chip{8, clock, gpio::recorder(writes)};
    std::atomic<bool> bed_is_broken{false}, has_heated{false};
    Heating heating;

    Board() {
        printer.pulse.late_limit_ns = 10'000'000'000;
        std::vector<thermal::Output> outputs;
        std::vector<thermal::HeaterPort> ports;
        for (const std::size_t i : {config::heater_tool, config::heater_bed}) {
            outputs.push_back({thermal::LineOutput{outputs.size(), thermal::SlowPwm(0.5)}, true});
            const auto read = [this, i]() -> Result<double> {
                return i == config::heater_bed && bed_is_broken ? 4'095.0 : 3'900.0;
            };
            ports.push_back({i, *printer.heaters[i], std::make_unique<thermal::MockSensor>(read)});
        }
        heating.chip =
            std::make_unique<gpio::MockChip>(2, clock, [this](const gpio::LineWrite& write) {
                heat_writes.push_back(write);
                if (write.levels != 0) has_heated = true;
            });
        heating.stage =
            std::make_unique<thermal::PowerStage>(std::move(outputs), heating.chip.get());
        heating.control =
            std::make_unique<thermal::HeatControl>(std::move(ports), false, *heating.stage);
    }
    // It heated, and at the end nothing is on; it waited for heat, and no axis moved.
    void check_ended() const {
        CHECK(chip.released());
        CHECK(chip.levels() == 0);
        bool was_on = false, stepped = false;
        for (const gpio::LineWrite& write : heat_writes) was_on = was_on || write.levels != 0;
        for (const gpio::LineWrite& write : writes)
            stepped = stepped || (write.levels & all_step_bits) != 0;
        CHECK(was_on);
        CHECK_FALSE(stepped);
        REQUIRE_FALSE(heat_writes.empty());
        CHECK(heat_writes.back().levels == 0);
    }
};

}  // namespace

TEST_CASE("print 2: a guard that fires in a real print takes heat and motion away") {
    Board board;
    const std::string file = write_print("heat_real", {draw_square}, {}, heated(210, 60));
    int calls = 0;
    const ProgressSink breaks = [&](const Progress&) { board.bed_is_broken = ++calls > 3; };
    const Result<PrintReport> report =
        print({file, board.printer, false, breaks}, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::machine);
    CHECK_MESSAGE(report.error().message.find("heater bed") != std::string::npos,
                  report.error().message);
    board.check_ended();
}

TEST_CASE("print 3, 4: SIGTERM while a print waits for heat ends both") {
    Board board;
    const std::string file = write_print("heat_stopped", {draw_square}, {}, heated(210, 60));
    bool is_raised = false;
    const ProgressSink stops = [&](const Progress&) {
        if (board.has_heated && !std::exchange(is_raised, true)) std::raise(SIGTERM);
    };
    const Result<PrintReport> report =
        print({file, board.printer, false, stops}, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::stopped);
    board.check_ended();
}

TEST_CASE("print 2: a file that heats is not printed cold by mistake") {
    Board board;
    const std::string file = write_print("heat_mistake", {draw_square}, {}, heated(210, 60));
    const Result<PrintReport> report =
        print({file, board.printer, false, {}}, board.chip, board.clock);
    REQUIRE_FALSE(report.ok());
    CHECK(board.writes.empty());
}

TEST_CASE(
    "heating 1: a fan by another path to the heater's channel switched the heater on after a "
    "guard") {
    const std::filesystem::path folder = lyr::tests::scratch_folder("heat_same"),
                                link = lyr::tests::scratch("heat_same_link");
    for (const char* name : {"period", "duty_cycle", "enable", "sensor"})
        std::ofstream(folder / name) << 25 << '\n';
    std::filesystem::remove(link);
    std::filesystem::create_directory_symlink(folder, link);
    config::Printer printer = config::generic_printer();
    config::Heater& tool = *printer.heaters[config::heater_tool];
    tool.sensor.kind = config::SensorKind::celsius;
    tool.sensor.celsius_per_unit = 1;
    tool.sensor.file = folder / "sensor";
    tool.pwm = folder.string() + '/';
    printer.heaters[config::heater_bed].reset();
    const auto refused = [&](const std::string& key, const std::string& other) {
        const Result<Heating> heating = open_heating(printer);
        REQUIRE_FALSE(heating.ok());
        CHECK(heating.error().status == ExitStatus::machine);
        const std::string& message = heating.error().message;
        CHECK_MESSAGE(message.starts_with(key + ": "), message);
        CHECK_MESSAGE(message.find(" is " + other + " too,") != std::string::npos, message);
    };
    printer.part_fan->pwm = link;
    refused("fan.part.pwm", "heater.tool.pwm");
    printer.part_fan.reset();
    printer.heaters[config::heater_bed] = tool;
    printer.heaters[config::heater_bed]->pwm = "/nonexistent/pwm0";
    printer.heaters[config::heater_bed]->sensor.file = link / "sensor";
    refused("heater.bed.sensor.file", "heater.tool.sensor.file");
    std::filesystem::remove(link);
    std::filesystem::remove_all(folder);
}

TEST_CASE("heating 1: what is missing to heat is told by its key or file") {
    config::Printer printer = config::generic_printer();
    const auto complaint = [&] {
        const Result<Heating> refused = open_heating(printer);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().status == ExitStatus::machine);
        return to_string(refused.error());
    };
    CHECK(complaint().find("heater.tool.sensor.file") != std::string::npos);
    printer.heaters[config::heater_tool]->sensor.file = "/nonexistent/in_voltage0_raw";
    CHECK(complaint().find("heater.tool.output") != std::string::npos);
    printer.heaters[config::heater_tool]->output = config::Pin{"gpiochip987", 3u, false};
    CHECK(complaint().find("/nonexistent/in_voltage0_raw") != std::string::npos);
    const std::string sensor = lyr::tests::scratch("heat_sensor");
    std::ofstream(sensor) << "3900\n";
    printer.heaters[config::heater_tool]->sensor.file = sensor;
    printer.heaters[config::heater_bed].reset();
    CHECK(complaint().find("gpiochip987") != std::string::npos);
    printer.heaters[config::heater_tool]->output.reset();
    printer.heaters[config::heater_tool]->pwm = "/nonexistent/pwm0";
    CHECK(complaint().find("/nonexistent/pwm0") != std::string::npos);
    std::filesystem::remove(sensor);
}
