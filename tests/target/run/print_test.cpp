// Contract of target/run/print.h, by number: real threads and the real clock, with lines that lead to a
// recording. Contract of stop_signals.h and event_ring.h, by number.

#include "target/run/print.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "target/gpio/mock_chip.h"
#include "target/run/event_ring.h"
#include "target/run/event_stream.h"
#include "target/run/executor.h"
#include "target/run/patient_printer.h"
#include "target/run/print_files.h"
#include "target/run/stop_signals.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

std::vector<LineEvent> events_of(const std::string& file, const config::Printer& printer) {
    Result<EventStream> stream = EventStream::open(file, printer, 1.75);
    REQUIRE(stream.ok());
    std::vector<LineEvent> events;
    for (;;) {
        const Result<bool> more = stream->next(events);
        REQUIRE(more.ok());
        if (!*more) return events;
    }
}

constexpr std::size_t lines = 8;

}  // namespace

TEST_CASE(
    "print 3, 5: the pulses are the simulation's, no gap is shorter, and the lines are released") {
    const config::Printer printer = patient_printer();
    const std::string file = write_print("real", {draw_small});
    const std::vector<LineEvent> events = events_of(file, printer);
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(lines, clock, gpio::recorder(writes));
    const Result<PrintReport> report = print({file, printer, false, {}}, chip, clock);
    REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : report.error().message));
    CHECK(chip.released());
    CHECK(chip.levels() == 0);
    REQUIRE(writes.size() > events.size() + 1);
    // What lifts the head before the last event.
    writes.erase(writes.begin() + static_cast<std::ptrdiff_t>(events.size() - 1), writes.end() - 2);
    std::size_t different = 0, shortened = 0;
    std::vector<std::size_t> steps;
    for (std::size_t i = 0; i < events.size(); ++i) {
        different += writes[i].levels != events[i].levels;
        if (i > 0 && (~events[i - 1].levels & events[i].levels & all_step_bits) != 0)
            steps.push_back(i);
    }
    // Steps fall behind their events and never catch up; pulses may end late. Recorded times are read a moment after the one
    // that the executor measured from, a long one where the system does something else just then: so a step is compared
    // with the one of the last four that was recorded the least late.
    constexpr std::int64_t reading_ns = 100'000;
    const auto behind_ns = [&](std::size_t k) {
        return writes[steps[k]].time_ns - events[steps[k]].time_ns;
    };
    for (std::size_t k = 4; k < steps.size(); ++k)
        shortened += behind_ns(k) < std::min({behind_ns(k - 1), behind_ns(k - 2), behind_ns(k - 3),
                                              behind_ns(k - 4)}) -
                                        reading_ns;
    CHECK(different == 0);
    CHECK(shortened == 0);
    CHECK(report->planned_s == doctest::Approx(static_cast<double>(events.back().time_ns) / 1e9));
    CHECK(report->stretched_s >= 0);
}

TEST_CASE("print 4: SIGTERM brings the head to rest on its path, with all lines released") {
    const config::Printer printer = patient_printer();
    std::vector<Drawing> drawings(40, draw_square);
    const std::string file = write_print("sigterm", drawings);
    const std::vector<LineEvent> events = events_of(file, printer);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        gpio::MonotonicClock clock;
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(lines, clock, gpio::recorder(writes));
        bool sent = false;
        const ProgressSink progress = [&](const Progress& now) {
            if (now.time_s > 0.3 && !sent) std::raise(signal), sent = true;
        };
        const Result<PrintReport> report = print({file, printer, false, progress}, chip, clock);
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().status == ExitStatus::stopped);
        CHECK(report.error().message.find("released") != std::string::npos);
        CHECK(chip.released());
        REQUIRE(writes.size() > 2);
        CHECK(writes.size() < events.size());
        CHECK(writes.back().levels == 0);
        writes.pop_back();
        std::size_t different = 0;
        for (std::size_t i = 0; i < writes.size(); ++i)
            different += writes[i].levels != events[i].levels;
        CHECK(different == 0);
        CHECK((writes.back().levels & all_step_bits) == 0);
    }
}

TEST_CASE("print 3, 7: a line that cannot be written ends the print, and the rest is released") {
    const config::Printer printer = patient_printer();
    const std::string file = write_print("broken_line", {draw_square});
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(
        lines, clock, gpio::recorder(writes),
        [](std::uint64_t number) -> std::optional<Diagnostic> {
            if (number != 500) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "bus error", {}};
        });
    const Result<PrintReport> report = print({file, printer, false, {}}, chip, clock);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message == "bus error; the printer has stopped, and its position is lost");
    CHECK(chip.released());
    CHECK(chip.levels() == 0);
}

TEST_CASE("print 2: a file that heats is refused, unless it is to be printed cold") {
    const std::string file = write_print("heat", {draw_small}, {}, [](format::LayerState& state) {
        state.temperatures.push_back({{format::HeaterKind::bed, 0}, 100});
        state.temperatures.push_back({{format::HeaterKind::tool, 0}, 230});
    });
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(lines, clock, gpio::recorder(writes));
    PrintJob job{file, patient_printer(), false, {}};
    const Result<PrintReport> refused = print(job, chip, clock);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::machine);
    CHECK(refused.error().message.find("the bed to 100 °C, tool 0 to 230 °C") != std::string::npos);
    CHECK(refused.error().message.find("--no-heat") != std::string::npos);
    CHECK(writes.empty());
    job.no_heat = true;
    const Result<PrintReport> cold = print(job, chip, clock);
    REQUIRE(cold.ok());
    REQUIRE_FALSE(cold->warnings.empty());
    CHECK(cold->warnings[0].message.find("not heated") != std::string::npos);
}

TEST_CASE("print 2: a temperature of 0 heats nothing and is no reason to refuse") {
    const std::string file = write_print("cold", {draw_small}, {}, [](format::LayerState& state) {
        state.temperatures.push_back({{format::HeaterKind::bed, 0}, 0});
    });
    gpio::MonotonicClock clock;
    gpio::MockChip chip(lines, clock, {});
    CHECK(print({file, patient_printer(), false, {}}, chip, clock).ok());
}

TEST_CASE("print 1: a damaged file and a path out of range move nothing") {
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(lines, clock, gpio::recorder(writes));
    CHECK_FALSE(print({"/nonexistent.lyr", patient_printer(), false, {}}, chip, clock).ok());
    config::Printer small = patient_printer();
    small.axes[config::axis_x].max_mm = 30;
    CHECK_FALSE(print({write_print("small", {draw_small}), small, false, {}}, chip, clock).ok());
    CHECK(writes.empty());
}

TEST_CASE(
    "print: a printer without lines names the key that is missing; without a chip, the chip") {
    const std::string file = write_print("no_lines", {draw_small});
    const auto no_lines = print({file, patient_printer(), false, {}});
    REQUIRE_FALSE(no_lines.ok());
    CHECK(no_lines.error().status == ExitStatus::machine);
    CHECK(no_lines.error().message.find("axis.x.step") != std::string::npos);
    config::Printer printer = patient_printer();
    for (std::uint32_t i = 0; i < 4; ++i) {
        printer.axes[i].step = config::Pin{"gpiochip987", 2 * i, false};
        printer.axes[i].direction = config::Pin{"gpiochip987", 2 * i + 1, false};
    }
    const auto no_chip = print({file, printer, false, {}});
    REQUIRE_FALSE(no_chip.ok());
    CHECK(no_chip.error().message.find("gpiochip987") != std::string::npos);
}

TEST_CASE("stop signals 1, 2: an arrival is told once and kills nothing") {
    const StopSignals signals;
    CHECK_FALSE(signals.wait_ms(0));
    std::raise(SIGTERM);
    CHECK(signals.wait_ms(0));
    CHECK_FALSE(signals.wait_ms(1));
    std::raise(SIGINT);
    std::raise(SIGHUP);
    CHECK(signals.wait_ms(0));
    CHECK(signals.wait_ms(0));
    CHECK_FALSE(signals.wait_ms(0));
    std::raise(SIGTERM);  // fetched by the destructor
}

TEST_CASE("stop signals 1: a signal that is ignored stays ignored") {
    const auto before = std::signal(SIGHUP, SIG_IGN);
    {
        const StopSignals signals;
        std::raise(SIGHUP);
        CHECK_FALSE(signals.wait_ms(0));
        std::raise(SIGINT);
        CHECK(signals.wait_ms(0));
    }
    std::signal(SIGHUP, before);
}

TEST_CASE("stop signals 3: a SIGTERM between homing and the print was lost") {
    const StopSignals of_print;
    {
        const StopSignals of_homing;
        std::raise(SIGTERM);
    }
    CHECK(of_print.wait_ms(0));
    CHECK_FALSE(of_print.wait_ms(0));
}

TEST_CASE("event ring 1, 3: everything comes out once and in order, between two threads") {
    EventRing ring(256);
    constexpr std::int64_t count = 200'000;
    std::thread producer([&] {
        std::vector<LineEvent> batch;
        for (std::int64_t next = 0; next < count;) {
            batch.clear();
            for (std::int64_t i = 0; i < 1 + next % 300 && next + i < count; ++i)
                batch.push_back({next + i, static_cast<gpio::LineMask>(next + i)});
            std::span<const LineEvent> left(batch);
            while (!left.empty()) {
                const std::size_t pushed = ring.push(left);
                left = left.subspan(pushed);
                if (!pushed) std::this_thread::yield();
            }
            next += static_cast<std::int64_t>(batch.size());
        }
        ring.close();
    });
    std::int64_t expected = 0, wrong = 0;
    while (!ring.ended()) {
        const std::span<const LineEvent> events = ring.view();
        for (const LineEvent& event : events) wrong += event.time_ns != expected++;
        ring.drop(events.size());
        if (events.empty()) std::this_thread::yield();
    }
    producer.join();
    CHECK(expected == count);
    CHECK(wrong == 0);
}

TEST_CASE("event ring 1: a full ring takes no more") {
    EventRing ring(4);
    const std::vector<LineEvent> six(6);
    CHECK(ring.push(six) == 4);
    CHECK(ring.push(six) == 0);
    ring.drop(1);
    CHECK(ring.push(six) == 1);
}

TEST_CASE("print: the report left out what a lower speed had cost") {
    const std::string file = write_print("slowed", {draw_square});
    gpio::MonotonicClock clock;
    const auto printed = [&](double speed) {
        gpio::MockChip chip(8, clock, {});
        PrintControl control;
        control.post(SetSpeedFactor{speed});
        PrintJob job{file, patient_printer(), true, {}};
        job.control = &control;
        const Result<PrintReport> report = print(job, chip, clock);
        REQUIRE_MESSAGE(report.ok(), report.error().message);
        return *report;
    };
    const PrintReport slow = printed(0.5);
    // As long again, but for the first moments, until the command is served.
    CHECK(slow.slowed_s > 0.7 * slow.planned_s);
    CHECK(slow.slowed_s < 1.3 * slow.planned_s);
    CHECK(text_of(slow).find(" more at the lower speed asked for") != std::string::npos);
    CHECK(printed(1).slowed_s < 0.1);
}
