// Contracts of target/home/mover.h and step_tally.h, by number: with virtual time, and with threads on the real clock as
// on a board.

#include "target/home/mover.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

#include "target/home/heap.h"
#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;
using config::Kinematics;

namespace {

// A machine for two threads: one writes its lines, the other reads its contacts.
class SharedMachine final : public gpio::GpioChip, public gpio::InputLines {
public:
    SharedMachine(std::int64_t count, const gpio::Clock& clock) : count_(count), clock_(clock) {}

    std::size_t line_count() const override { return 8; }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        const std::lock_guard lock(mutex_);
        const gpio::LineMask after = (levels_ & ~changed) | (levels & changed);
        if (after & ~levels_ & run::step_bit(0)) count_ += after & run::direction_bit(0) ? 1 : -1;
        levels_ = after;
        const bool active = count_ <= 0;
        if (active != active_) edges_.push_back({clock_.now_ns(), 0, active});
        active_ = active;
        return Done{};
    }
    Status release() override { return Done{}; }
    Result<gpio::LineMask> read() override {
        const std::lock_guard lock(mutex_);
        return gpio::LineMask{active_};
    }
    Result<std::size_t> collect(std::span<gpio::InputEdge> edges) override {
        const std::lock_guard lock(mutex_);
        const std::size_t count = std::min(edges.size(), edges_.size());
        std::copy_n(edges_.begin(), count, edges.begin());
        edges_.erase(edges_.begin(), edges_.begin() + static_cast<std::ptrdiff_t>(count));
        return count;
    }
    Result<bool> wait_ns(std::int64_t time_ns) override {
        std::this_thread::sleep_for(std::chrono::nanoseconds(time_ns));
        return true;
    }
    std::int64_t count() const {
        const std::lock_guard lock(mutex_);
        return count_;
    }

private:
    mutable std::mutex mutex_;
    std::int64_t count_;
    const gpio::Clock& clock_;
    gpio::LineMask levels_ = 0;
    bool active_ = false;
    std::vector<gpio::InputEdge> edges_;
};

config::Printer one_axis() {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.axes[config::axis_x].max_mm = 10;
    printer.axes[config::axis_x].min_mm = 0;
    printer.endstops = {};
    printer.endstops[0].input = config::Pin{"c", 1u, false};
    printer.endstops[0].fast_mm_s = 50;
    printer.endstops[0].slow_mm_s = 10;
    printer.endstops[0].back_off_mm = 0.5;
    printer.homing.lift_mm = 0;
    printer.pulse.late_limit_ns = 10'000'000'000;  // the machine of a test may be busy
    return printer;
}

}  // namespace

TEST_CASE("tally 1, 2: the counts at any time are those after the last write before it") {
    gpio::VirtualClock clock;
    gpio::MockChip mock(8, clock, {});
    StepTally tally(mock, clock);
    std::vector<std::pair<std::int64_t, motion::StepCounts>> seen;
    for (int i = 0; i < 500; ++i) {
        clock.advance_ns(1'000);
        const gpio::LineMask direction = i % 7 < 4 ? run::direction_bit(1) : 0;
        const gpio::LineMask steps =
            run::step_bit(1) | (i % 3 == 0 ? run::step_bit(0) : gpio::LineMask{0});
        REQUIRE(tally.write(0xff, direction | steps).ok());
        seen.emplace_back(clock.now_ns(), tally.counts());
        clock.advance_ns(300);
        REQUIRE(tally.write(steps, 0).ok());
    }
    CHECK(tally.counts()[0] == -167);
    CHECK(*tally.counts_at(0) == motion::StepCounts{});
    for (const auto& [time_ns, counts] : seen) {
        CHECK(*tally.counts_at(time_ns) == counts);
        CHECK(*tally.counts_at(time_ns + 999) == counts);
    }
    for (std::size_t i = 0; i <= StepTally::remembered; ++i) {
        clock.advance_ns(10);
        REQUIRE(tally.write(run::step_bit(2), run::step_bit(2)).ok());
        REQUIRE(tally.write(run::step_bit(2), 0).ok());
    }
    CHECK_FALSE(tally.counts_at(500));
    CHECK(*tally.counts_at(clock.now_ns()) == tally.counts());
}

TEST_CASE("tally 3, inputs 6: counting steps and collecting edges allocates nothing") {
    gpio::VirtualClock clock;
    gpio::MockChip mock(8, clock, {});
    gpio::MockInputs inputs(1, clock);
    StepTally tally(mock, clock);
    std::array<gpio::InputEdge, 4> edges{};
    allocations = 0;
    counts_allocations = true;
    std::size_t collected = 0;
    for (int i = 0; i < 100'000; ++i) {
        clock.advance_ns(100);
        const bool ok = tally.write(0xff, i % 2 == 0 ? 0xff : 0).ok();
        inputs.set(0, i % 2 == 0);
        collected += ok ? *inputs.collect(edges) : 0;
    }
    counts_allocations = false;
    CHECK(allocations == 0);
    CHECK(collected == 100'000);
}

TEST_CASE("mover 1, 2: a contact stops the machine on its path, and what it ran on is counted") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.simulated.head_mm = {10.003, 100, 50};
    Scene scene(printer);
    printer.start_mm = {10.003, 100, 50};
    Contacts watched;
    watched[0] = true;
    const auto moved = scene.mover.run(printer, along_x(printer, -40, 100), watched);
    REQUIRE_MESSAGE(moved.ok(), moved.error().message);
    REQUIRE(moved->at_contact[0]);
    CHECK((*moved->at_contact[0])[0] == -801);  // the first step at or beyond 0
    CHECK(moved->counts[0] < -801);
    CHECK(moved->counts[0] > -1'600);
    CHECK(moved->counts[1] == 0);
    const auto back = scene.mover.run(printer, along_x(printer, 5, 100));
    REQUIRE(back.ok());
    CHECK(scene.machine.chip().levels() == 0);
    CHECK(scene.machine.head().x ==
          doctest::Approx(10.003 + static_cast<double>(moved->counts[0] + back->counts[0]) / 80));
}

TEST_CASE("mover 4: homed with threads on the real clock, as on a board") {
    const config::Printer printer = one_axis();
    gpio::MonotonicClock clock;
    SharedMachine bench(3 * 80 + 17, clock);
    const run::StopSignals signals;
    Mover mover(printer, bench, clock, &bench, [&] { return signals.wait_ms(0) ? 1U : 0U; });
    const auto homed = home::home(mover, printer, homable(printer));
    REQUIRE_MESSAGE(homed.ok(), homed.error().message);
    CHECK(std::abs(homed->head.x * 80 - static_cast<double>(bench.count())) <= 1.01);
    CHECK(homed->repeat_mm <= 0.05);
}

TEST_CASE("mover 3: a signal brings the machine to rest, with status stopped") {
    const config::Printer printer = one_axis();
    gpio::MonotonicClock clock;
    SharedMachine bench(1'000'000, clock);
    const run::StopSignals signals;
    Mover mover(printer, bench, clock, &bench, [&] { return signals.wait_ms(0) ? 1U : 0U; });
    std::thread user([&bench] {
        // Once it moves, however busy the machine is.
        for (int i = 0; i < 2'000 && bench.count() < 1'000'080; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        ::kill(::getpid(), SIGTERM);
    });
    const auto moved = mover.run(printer, along_x(printer, 100, 20), {});
    user.join();
    REQUIRE_FALSE(moved.ok());
    CHECK(moved.error().status == ExitStatus::stopped);
    CHECK(bench.count() > 1'000'000);
    CHECK(bench.count() < 1'000'000 + 100 * 80);
}

TEST_CASE("mover 1: a contact that had closed when an approach began never triggered") {
    config::Printer printer = one_axis();
    gpio::VirtualClock clock;
    gpio::MockInputs inputs(1, clock);
    gpio::MockChip chip(8, clock, {});
    Mover mover(printer, chip, clock, &inputs, nullptr);
    printer.start_mm = {8, 0, 0};
    REQUIRE(mover.run(printer, along_x(printer, 0.5, 50)).ok());
    inputs.set(0, true, clock.now_ns());
    const auto moved = mover.run(printer, along_x(printer, -8, 50), Contacts(1));
    REQUIRE_MESSAGE(moved.ok(), moved.error().message);
    REQUIRE(moved->at_contact[0]);
    CHECK(*moved->at_contact[0] == motion::StepCounts{});
    CHECK(moved->counts[0] < 0);
    CHECK(moved->counts[0] > -200);
}

TEST_CASE("mover 1: a contact that was still bouncing when the machine came to rest was lost") {
    for (const bool settles : {true, false}) {
        CAPTURE(settles);
        config::Printer printer = one_axis();
        gpio::VirtualClock clock;
        gpio::MockInputs inputs(1, clock);
        int rises = 0;
        gpio::LineMask before = 0;
        gpio::MockChip chip(8, clock, [&](const gpio::LineWrite& write) {
            rises += (write.levels & ~before & run::step_bit(0)) != 0;
            const bool touches = rises == 80 && (write.levels & ~before & run::step_bit(0)) != 0;
            before = write.levels;
            // Edges up to 3 ms after the touch, or for longer than one would wait.
            for (int i = 0; touches && i <= (settles ? 10 : 200); ++i)
                inputs.set(0, i % 2 == 0, write.time_ns + i * 300'000);
        });
        Mover mover(printer, chip, clock, &inputs, nullptr);
        printer.start_mm = {8, 0, 0};
        const auto moved = mover.run(printer, along_x(printer, -1, 20), Contacts(1));
        REQUIRE_MESSAGE(moved.ok(), moved.error().message);
        CHECK(moved->counts[0] == -80);
        REQUIRE(moved->at_contact[0].has_value() == settles);
        if (settles) CHECK((*moved->at_contact[0])[0] == -80);
        CHECK(clock.now_ns() < 500'000'000);
    }
}
