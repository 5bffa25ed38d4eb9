// What the real-time thread runs must not allocate: executor.h's contract 8 and event_ring.h's 2. Allocations
// are counted in the thread that asks for it only.

#include <doctest/doctest.h>

#include <cstdlib>
#include <new>
#include <thread>

#include "target/gpio/mock_chip.h"
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

TEST_CASE(
    "executor 8: from its first write on, the real-time thread of a print allocates nothing") {
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

}  // namespace lyr::run
