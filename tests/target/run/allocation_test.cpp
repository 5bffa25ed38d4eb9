// What the real-time thread runs must not allocate: the contracts of executor.h (8), course.h (3) and event_ring.h (2).
// Allocations are counted in the thread that asks for it only.

#include <doctest/doctest.h>

#include <cstdlib>
#include <functional>
#include <new>
#include <thread>

#include "target/gpio/mock_chip.h"
#include "target/run/course.h"
#include "target/run/event_ring.h"
#include "target/run/executor.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

namespace {

thread_local bool counts = false;
thread_local std::size_t allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
    if (counts) ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    if (counts) ++allocations;
    return std::malloc(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace lyr::run {
namespace {

std::vector<LineEvent> pulses(std::size_t steps) {
    PulseSchedule schedule({}, 0);
    std::vector<LineEvent> events;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto time_ns = static_cast<std::int64_t>(i) * 20'000;
        const Step step{time_ns, static_cast<std::uint8_t>(i % 4), i % 1000 < 500};
        schedule.append(std::span(&step, 1), events);
    }
    schedule.finish(0, events);
    return events;
}

}  // namespace

TEST_CASE("executor 8, ring 2: taking events from the ring and writing them allocates nothing") {
    const std::vector<LineEvent> events = pulses(20'000);
    counts = true;
    const std::vector<LineEvent> copy(events);
    counts = false;
    REQUIRE(allocations == 1);  // it does count
    EventRing ring(1 << 10);
    std::uint64_t edges = 0;
    // Late now and then, for the time base to stretch.
    gpio::VirtualClock clock;
    gpio::TracingClock traced(clock);
    gpio::MockChip chip(8, clock, [&](const gpio::LineWrite&) {
        if (++edges % 97 == 0) clock.advance_ns(30'000);
    });
    StopRequests stop{0};
    Executor executor(chip, traced, {2'000, 5'000'000, 60'000'000}, stop);
    std::size_t allocated = 1;
    bool executed = true;
    std::thread real_time([&] {
        counts = true;
        while (!ring.ended()) {
            const std::span<const LineEvent> waiting = ring.view();
            // The last third is braked.
            if (edges > events.size() * 2 / 3) stop.store(1);
            if (!waiting.empty()) {
                const Result<bool> done = executor.execute(waiting);
                executed = executed && done.ok();
            }
            ring.drop(waiting.size());
        }
        counts = false;
        allocated = allocations;
    });
    for (std::span<const LineEvent> left(events); !left.empty(); std::this_thread::yield())
        left = left.subspan(ring.push(left));
    ring.close();
    real_time.join();
    CHECK(allocated == 0);
    CHECK(executed);
    CHECK(executor.writes() > events.size() / 2);
    CHECK(executor.stretched_ns() > 0);
    CHECK(chip.release().ok());
}

namespace {

// Whatever thread writes is the real-time one; it is watched from its first write on.
class TrappedChip final : public gpio::GpioChip {
public:
    std::size_t line_count() const override { return 8; }
    Status write(gpio::LineMask, gpio::LineMask) override {
        if (!counts) before_ = allocations;
        counts = true;
        ++writes;
        return Done{};
    }
    Status release() override {
        counts = false;
        allocated = allocations - before_;
        return Done{};
    }

    std::uint64_t writes = 0;
    std::size_t allocated = 0;

private:
    std::size_t before_ = 0;
};

}  // namespace

TEST_CASE("executor 8: from its first write on, the real-time thread of a print allocates nothing" *
          doctest::test_suite("long")) {
    config::Printer printer = config::generic_printer();
    // Machines that run tests are late now and then.
    printer.pulse.late_limit_ns = 10'000'000'000;
    const std::string file =
        tests::write_print("no_allocation", std::vector<tests::Drawing>(3, tests::draw_square));
    gpio::MonotonicClock clock;
    TrappedChip chip;
    const auto report = print({file, printer, true, {}}, chip, clock);
    REQUIRE_MESSAGE(report.ok(), report.error().message);
    CHECK(chip.writes == report->writes);
    CHECK(chip.writes > 1'000);
    CHECK(chip.allocated == 0);
}

TEST_CASE("course 3: resting, trips and going on allocate nothing on the thread that does them") {
    const std::vector<LineEvent> events = pulses(8'000);
    Trip trip;
    PulseSchedule schedule({}, 0);
    schedule.begin(0, trip);
    const Step there{1'000'000, 2, true}, back{2'000'000, 2, false};
    schedule.append(std::span(&there, 1), trip);
    schedule.append(std::span(&back, 1), trip);
    schedule.finish_as_begun(trip);
    gpio::VirtualClock clock;
    StopRequests stop{0};
    Course course;
    std::uint64_t edges = 0;
    bool has_rested = false;
    gpio::MockChip chip(8, clock, [&](const gpio::LineWrite&) {
        if (++edges == 4'000) course.wanted_pace = 0;
    });
    // Whoever lives the print's life, asked from the clock.
    class Living final : public gpio::Clock {
    public:
        Living(gpio::VirtualClock& inner, const std::function<void()>& live)
            : inner_(inner), live_(live) {}
        std::int64_t now_ns() const override { return inner_.now_ns(); }
        std::int64_t wait_until_ns(std::int64_t time_ns) override {
            live_();
            return inner_.wait_until_ns(time_ns);
        }

    private:
        gpio::VirtualClock& inner_;
        const std::function<void()>& live_;
    };
    const std::function<void()> live = [&] {
        if (!course.at_rest || course.trip.load()) return;
        if (has_rested) course.wanted_pace = 1;
        if (!has_rested) {
            // Its direction line is where the path left it.
            for (LineEvent& event : trip) event.levels |= course.levels & direction_bit(0);
            course.trip = &trip;
        }
        has_rested = true;
    };
    Living living(clock, live);
    Executor executor(chip, living, {2'000, 5'000'000, 60'000'000}, stop, nullptr,
                      &course.wanted_pace);
    allocations = 0;
    counts = true;
    const Result<bool> done = follow(events, executor, course, living, stop);
    counts = false;
    CHECK(allocations == 0);
    REQUIRE(done.ok());
    CHECK(*done);
    CHECK(has_rested);
    CHECK(executor.trip_steps() == StepPositions{});
    CHECK(executor.positions() == course.steps_on_path());
    CHECK(executor.writes() == events.size() + trip.size());
}

}  // namespace lyr::run
