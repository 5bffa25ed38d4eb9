// Contract of target/run/executor.h, by number, on a virtual clock that is late and slow in all ways.

#include "target/run/executor.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "target/gpio/mock_chip.h"
#include "target/run/pulse_decoder.h"

using namespace lyr;
using namespace lyr::run;

namespace {

const config::PulseTiming pulse{2'000, 3'000, 1'000, 500, 5'000'000};
const ExecutorTiming timing{3'000, 5'000'000, 60'000'000};

// The clock does not begin at 0.
constexpr std::int64_t start_ns = 77'000;

// A steady run on x with one reversal, and y at a third of the rate.
std::vector<LineEvent> train(std::size_t steps, std::int64_t gap_ns) {
    PulseSchedule schedule(pulse, 0);
    std::vector<LineEvent> events;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto time_ns = 1'000'000 + static_cast<std::int64_t>(i) * gap_ns;
        const Step x{time_ns, 0, i < steps / 2};
        const Step y{time_ns + gap_ns / 3, 1, true};
        schedule.append(std::span(&x, 1), events);
        if (i % 3 == 0) schedule.append(std::span(&y, 1), events);
    }
    schedule.finish(0, events);
    return events;
}

// A chip whose writes take time.
class SlowChip final : public gpio::GpioChip {
public:
    SlowChip(gpio::GpioChip& inner, gpio::VirtualClock& clock,
             std::function<std::int64_t()> duration)
        : inner_(inner), clock_(clock), duration_(std::move(duration)) {}
    std::size_t line_count() const override { return inner_.line_count(); }
    // The lines change somewhere within the call; with both ends kept, the worst case can be judged.
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        begins.push_back(clock_.now_ns());
        Status written = inner_.write(changed, levels);
        clock_.advance_ns(duration_());
        ends.push_back(clock_.now_ns());
        return written;
    }
    Status release() override { return inner_.release(); }
    std::vector<std::int64_t> begins, ends;

private:
    gpio::GpioChip& inner_;
    gpio::VirtualClock& clock_;
    std::function<std::int64_t()> duration_;
};

struct Outcome {
    std::vector<gpio::LineWrite> writes;
    Result<bool> result = true;
    std::int64_t stretched_ns = 0, worst_late_ns = 0;
};

Outcome execute(const std::vector<LineEvent>& events, gpio::VirtualClock::Lateness lateness,
                const StopRequests& stop, ExecutorTiming limits = timing) {
    Outcome outcome;
    gpio::VirtualClock clock(std::move(lateness));
    clock.advance_ns(start_ns);
    gpio::MockChip chip(8, clock, gpio::recorder(outcome.writes));
    Executor executor(chip, clock, limits, stop);
    outcome.result = executor.execute(events);
    outcome.stretched_ns = executor.stretched_ns();
    outcome.worst_late_ns = executor.worst_late_ns();
    return outcome;
}

// The events or writes that make a step.
template <class Event>
std::vector<std::size_t> steps_of(const std::vector<Event>& events) {
    std::vector<std::size_t> places;
    for (std::size_t i = 1; i < events.size(); ++i)
        if (~events[i - 1].levels & events[i].levels & all_step_bits) places.push_back(i);
    return places;
}

// Number of gaps that are shorter than planned, over every pair of neighbouring steps.
std::size_t shortened(const std::vector<LineEvent>& events,
                      const std::vector<gpio::LineWrite>& writes) {
    std::size_t count = 0;
    const std::vector<std::size_t> steps = steps_of(writes);
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const std::size_t i = steps[k - 1], j = steps[k];
        count += writes[j].time_ns - writes[i].time_ns < events[j].time_ns - events[i].time_ns;
    }
    return count;
}

bool same_levels(const std::vector<LineEvent>& events, const std::vector<gpio::LineWrite>& writes) {
    return std::equal(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(writes.size()),
                      writes.begin(), writes.end(),
                      [](const auto& a, const auto& b) { return a.levels == b.levels; });
}

}  // namespace

TEST_CASE("executor 1: on a punctual clock every event is written at its time") {
    const std::vector<LineEvent> events = train(500, 25'000);
    const Outcome outcome = execute(events, {}, StopRequests{0});
    REQUIRE(outcome.result.ok());
    CHECK(*outcome.result);
    REQUIRE(outcome.writes.size() == events.size() + 1);  // and the release
    const std::int64_t base_ns = outcome.writes[0].time_ns - events[0].time_ns;
    CHECK(outcome.writes[0].time_ns == start_ns);
    for (std::size_t i = 0; i < events.size(); ++i)
        CHECK(outcome.writes[i].time_ns - base_ns == events[i].time_ns);
    CHECK(outcome.stretched_ns == 0);
}

TEST_CASE("executor 1, 2: late waits stretch time; no event is lost, doubled or hurried") {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const std::vector<LineEvent> events = train(3'000, 12'000);
        std::mt19937 random(seed);
        const auto lateness = [&](std::int64_t) -> std::int64_t {
            if (random() % 4) return 0;
            return random() % 50 ? random() % 3'000 : random() % 2'000'000;
        };
        Outcome outcome = execute(events, lateness, StopRequests{0});
        REQUIRE(outcome.result.ok());
        outcome.writes.pop_back();
        CHECK(outcome.writes.size() == events.size());
        CHECK(same_levels(events, outcome.writes));
        CHECK(shortened(events, outcome.writes) == 0);
        CHECK(outcome.stretched_ns > 0);
        const std::size_t last = steps_of(events).back();
        CHECK(outcome.writes[last].time_ns - start_ns ==
              events[last].time_ns - events.front().time_ns + outcome.stretched_ns);
    }
}

TEST_CASE("executor 2: after one late event everything else keeps its distance and stays late") {
    const std::vector<LineEvent> events = train(300, 12'000);
    bool done = false;
    const auto lateness = [&](std::int64_t time_ns) -> std::int64_t {
        if (done || time_ns < 1'500'000) return 0;
        done = true;
        return 900'000;
    };
    const Outcome outcome = execute(events, lateness, StopRequests{0});
    REQUIRE(outcome.result.ok());
    CHECK(outcome.worst_late_ns == 900'000);
    CHECK(outcome.stretched_ns == 900'000);
    std::size_t differing = 0;
    for (std::size_t i = 1; i < events.size(); ++i)
        differing += outcome.writes[i].time_ns - outcome.writes[i - 1].time_ns !=
                     events[i].time_ns - events[i - 1].time_ns;
    CHECK(differing == 1);
}

TEST_CASE("executor 3: slow writes never shorten what a driver needs, judged from end to begin") {
    const std::vector<LineEvent> events = train(2'000, 11'000);
    std::mt19937 random(4);
    gpio::VirtualClock clock([&](std::int64_t) -> std::int64_t { return random() % 500; });
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip mock(8, clock, gpio::recorder(writes));
    SlowChip chip(mock, clock, [&]() -> std::int64_t {
        return random() % 20 ? 800 + random() % 400 : random() % 40'000;
    });
    const StopRequests stop{0};
    Executor executor(chip, clock, timing, stop);
    const Result<bool> result = executor.execute(events);
    REQUIRE(result.ok());
    REQUIRE(chip.begins.size() == events.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < events.size(); ++i)
        for (std::size_t j = i + 1; j < std::min(i + 8, events.size()); ++j) {
            const std::int64_t planned_ns = events[j].time_ns - events[i].time_ns;
            wrong += chip.begins[j] - chip.ends[i] < std::min(planned_ns, timing.edge_gap_ns);
        }
    CHECK(wrong == 0);
    CHECK(shortened(events, writes) == 0);
}

TEST_CASE(
    "executor 2: writes as long as a pulse do not slow the head down, whatever they do to the "
    "pulse's end") {
    const std::vector<LineEvent> events = train(2'000, 100'000);
    gpio::VirtualClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip mock(8, clock, gpio::recorder(writes));
    SlowChip chip(mock, clock, [] { return 7'000; });
    const StopRequests stop{0};
    Executor executor(chip, clock, timing, stop);
    REQUIRE(executor.execute(events).ok());
    std::size_t differing = 0;
    const std::vector<std::size_t> steps = steps_of(events);
    for (std::size_t k = 1; k < steps.size(); ++k)
        differing += writes[steps[k]].time_ns - writes[steps[k - 1]].time_ns !=
                     events[steps[k]].time_ns - events[steps[k - 1]].time_ns;
    // Where a direction line turns right before the step: at the begin of y and at the reversal of x.
    CHECK(differing == 2);
    // And at the begin of x.
    CHECK(executor.stretched_ns() < 3 * 10'000);
    CHECK(executor.worst_late_ns() < 10'000);
}

TEST_CASE(
    "executor 3: writes of ordinary speed slow a print only where edges are as close as may be") {
    const std::vector<LineEvent> events = train(2'000, 50'000);
    gpio::VirtualClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip mock(8, clock, gpio::recorder(writes));
    SlowChip chip(mock, clock, [] { return 900; });
    const StopRequests stop{0};
    ExecutorTiming limits = timing;
    limits.edge_gap_ns = 1'000;
    Executor executor(chip, clock, limits, stop);
    REQUIRE(executor.execute(events).ok());
    // Between a turn and its step: at the begin of x and of y, and at the reversal of x.
    CHECK(executor.stretched_ns() == 3 * 900);
}

TEST_CASE("executor 4: an event beyond the late limit ends the print and says so") {
    const std::vector<LineEvent> events = train(300, 12'000);
    const auto lateness = [](std::int64_t time_ns) -> std::int64_t {
        return time_ns > 2'000'000 ? 6'000'000 : 0;
    };
    Outcome outcome = execute(events, lateness, StopRequests{0});
    REQUIRE_FALSE(outcome.result.ok());
    CHECK(outcome.result.error().status == ExitStatus::machine);
    CHECK(outcome.result.error().message.find("6.000 ms late") != std::string::npos);
    CHECK(outcome.writes.size() < events.size());
}

TEST_CASE("executor 5: a request to stop brakes on the path without losing a step") {
    const std::vector<LineEvent> events = train(20'000, 20'000);
    StopRequests stop{0};
    std::int64_t requested_ns = 0;
    const auto lateness = [&](std::int64_t time_ns) -> std::int64_t {
        if (time_ns > 100'000'000 && !requested_ns) {
            requested_ns = time_ns;
            stop = 1;
        }
        return 0;
    };
    Outcome outcome = execute(events, lateness, stop);
    REQUIRE(outcome.result.ok());
    CHECK_FALSE(*outcome.result);
    outcome.writes.pop_back();  // the release
    CHECK(outcome.writes.size() < events.size());
    CHECK(same_levels(events, outcome.writes));
    CHECK(shortened(events, outcome.writes) == 0);
    CHECK((outcome.writes.back().levels & all_step_bits) == 0);
    // At rest after roughly the braking time, and each step slower than the one before.
    const std::int64_t braked_ns = outcome.writes.back().time_ns - requested_ns;
    CHECK(braked_ns > timing.braking_ns / 2);
    CHECK(braked_ns < 2 * timing.braking_ns);
    const auto x_interval = [&](std::size_t back) {
        std::vector<std::int64_t> rises;
        for (std::size_t i = 1; i < outcome.writes.size(); ++i)
            if (~outcome.writes[i - 1].levels & outcome.writes[i].levels & step_bit(0))
                rises.push_back(outcome.writes[i].time_ns);
        return rises[rises.size() - back] - rises[rises.size() - back - 1];
    };
    CHECK(x_interval(1) > 10 * 20'000);
    CHECK(x_interval(1) > x_interval(3));
    CHECK(x_interval(3) > x_interval(30));
}

TEST_CASE("executor 5: a second request stops after the pulse that is out") {
    const std::vector<LineEvent> events = train(20'000, 20'000);
    StopRequests stop{0};
    std::int64_t requested_ns = 0;
    const auto lateness = [&](std::int64_t time_ns) -> std::int64_t {
        if (time_ns > 100'000'000 && !requested_ns) {
            requested_ns = time_ns;
            stop = 2;
        }
        return 0;
    };
    Outcome outcome = execute(events, lateness, stop);
    REQUIRE(outcome.result.ok());
    CHECK_FALSE(*outcome.result);
    outcome.writes.pop_back();
    CHECK((outcome.writes.back().levels & all_step_bits) == 0);
    CHECK(outcome.writes.back().time_ns - requested_ns <= 20'000 + pulse.high_ns);
}

namespace {

// Two motors at the same rate, half a period apart, whose pulses last longer than that: one is always out.
struct Overlapping {
    static constexpr config::PulseTiming pulse{25'000, 5'000, 1'000, 500, 5'000'000};
    static constexpr std::int64_t period_ns = 40'000;
    static constexpr std::size_t steps = 20'000;  // of each
    std::vector<LineEvent> events;

    Overlapping() {
        PulseSchedule schedule(pulse, 0);
        for (std::size_t i = 0; i < steps; ++i)
            for (const std::uint8_t axis : std::array<std::uint8_t, 2>{0, 1}) {
                const auto half = static_cast<std::int64_t>(2 * i + axis);
                const Step step{1'000'000 + half * period_ns / 2, axis, true};
                schedule.append(std::span(&step, 1), events);
            }
        schedule.finish(0, events);
    }
};

}  // namespace

TEST_CASE("executor 5: a stop among pulses that overlap waited for a gap that never came") {
    const Overlapping motors;
    const ExecutorTiming limits{25'000, 5'000'000, 60'000'000};
    for (const int requests : {1, 2}) {
        CAPTURE(requests);
        StopRequests stop{0};
        std::int64_t requested_ns = 0;
        gpio::VirtualClock clock([&](std::int64_t time_ns) -> std::int64_t {
            if (time_ns > 100'000'000 && !requested_ns) {
                requested_ns = time_ns;
                stop = requests;
            }
            return 0;
        });
        std::vector<gpio::LineWrite> writes;
        PulseDecoder decoder;
        gpio::MockChip chip(8, clock, [&](const gpio::LineWrite& write) {
            writes.push_back(write);
            decoder.write(write);
        });
        Executor executor(chip, clock, limits, stop);
        const Result<bool> result = executor.execute(motors.events);
        REQUIRE(result.ok());
        CHECK_FALSE(*result);
        CHECK((writes.back().levels & all_step_bits) == 0);
        const std::int64_t took_ns = writes.back().time_ns - requested_ns;
        CHECK(took_ns <= (requests > 1 ? Overlapping::pulse.high_ns : 2 * limits.braking_ns));
        for (const std::size_t axis : {0u, 1u}) {
            CHECK(decoder.figures(axis).shortest_high_ns >= Overlapping::pulse.high_ns);
            CHECK(executor.positions()[axis] == decoder.positions()[axis]);
        }
    }
}

TEST_CASE("executor 9: rests among pulses that overlap lose and double no step") {
    const Overlapping motors;
    const StopRequests stop{0};
    WantedPace pace{1};
    std::int64_t next_ns = 50'000'000;
    gpio::VirtualClock clock([&](std::int64_t time_ns) -> std::int64_t {
        if (time_ns > next_ns) pace = 0;
        return 0;
    });
    PulseDecoder decoder;
    gpio::MockChip chip(8, clock, [&](const gpio::LineWrite& write) { decoder.write(write); });
    Executor executor(chip, clock, {25'000, 5'000'000, 60'000'000}, stop, nullptr, &pace);
    std::span<const LineEvent> left(motors.events);
    const std::vector<Step> trip_steps{{1'000'000, 0, true}, {2'000'000, 0, false}};
    int rests = 0;
    for (;;) {
        const Result<bool> done = executor.execute(left);
        REQUIRE(done.ok());
        left = left.subspan(executor.taken());
        if (*done) break;
        ++rests;
        CHECK((executor.levels() & all_step_bits) == 0);
        // A trip of an axis whose pulse was ended.
        PulseSchedule schedule(Overlapping::pulse, executor.levels());
        std::vector<LineEvent> trip;
        schedule.begin(0, trip);
        schedule.append(trip_steps, trip);
        schedule.finish_as_begun(trip);
        executor.begin_trip();
        const Result<bool> back = executor.execute(trip);
        executor.end_trip();
        REQUIRE(back.ok());
        CHECK(*back);
        pace = 1;
        next_ns = clock.now_ns() + 100'000'000;
        executor.go_on();
    }
    CHECK(rests > 3);
    for (const std::size_t axis : {0u, 1u}) {
        CHECK(executor.positions()[axis] == Overlapping::steps);
        CHECK(executor.trip_steps()[axis] == 0);
        CHECK(decoder.positions()[axis] == Overlapping::steps);
        CHECK(decoder.figures(axis).shortest_high_ns >= Overlapping::pulse.high_ns);
        CHECK(decoder.figures(axis).shortest_low_ns >= Overlapping::pulse.low_ns);
    }
}

TEST_CASE("executor 5: a request during a long pause is answered within a slice") {
    const std::vector<LineEvent> events{{0, 0}, {60'000'000'000, step_bit(0)}};
    StopRequests stop{0};
    gpio::VirtualClock clock([&](std::int64_t time_ns) -> std::int64_t {
        if (time_ns > 3'000'000'000) stop = 1;
        return 0;
    });
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(8, clock, gpio::recorder(writes));
    Executor executor(chip, clock, timing, stop);
    const Result<bool> result = executor.execute(events);
    REQUIRE(result.ok());
    CHECK_FALSE(*result);
    CHECK(clock.now_ns() <= 3'000'000'000 + 2 * Executor::wait_slice_ns);
    CHECK(writes.size() == 1);
}

TEST_CASE("executor 6: a failed write ends the print with its own message") {
    const std::vector<LineEvent> events = train(100, 20'000);
    gpio::VirtualClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(
        8, clock, gpio::recorder(writes), [](std::uint64_t number) -> std::optional<Diagnostic> {
            if (number != 17) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "bus error", {}};
        });
    const StopRequests stop{0};
    Executor executor(chip, clock, timing, stop);
    const Result<bool> result = executor.execute(events);
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().message == "bus error");
    CHECK(writes.size() == 17);
}

TEST_CASE("executor 9: after a rest, steps that are far apart bring the pace back at once") {
    gpio::VirtualClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(8, clock, gpio::recorder(writes));
    const StopRequests stop{0};
    WantedPace pace{1};
    Executor executor(chip, clock, {2'000, 10'000'000, 100'000'000}, stop, nullptr, &pace);
    const auto pulses = [](std::int64_t from_ns, std::int64_t apart_ns, int count) {
        std::vector<LineEvent> events;
        for (int i = 0; i < count; ++i) {
            events.push_back({from_ns + i * apart_ns, step_bit(0)});
            events.push_back({from_ns + i * apart_ns + 2'000, 0});
        }
        return events;
    };
    REQUIRE(executor.execute(pulses(0, 30'000'000, 2)).ok());
    executor.go_on();
    const std::int64_t from_ns = clock.now_ns();
    REQUIRE(executor.execute(pulses(60'000'000, 30'000'000, 4)).ok());
    REQUIRE(executor.execute(pulses(180'000'000, 1'000'000, 20)).ok());
    CHECK(clock.now_ns() - from_ns < 180'000'000);
}
