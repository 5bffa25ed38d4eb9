// Contract of target/run/pulse_schedule.h and pulse_decoder.h, by number: what the one encodes the
// other decodes.

#include "target/run/pulse_schedule.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>

#include "target/run/pulse_decoder.h"

using namespace lyr;
using namespace lyr::run;

namespace {

const config::PulseTiming driver_timing{2'000, 3'000, 700, 400, 5'000'000};

std::vector<LineEvent> schedule_all(const std::vector<Step>& steps, PulseSchedule& schedule) {
    std::vector<LineEvent> events;
    schedule.append(steps, events);
    schedule.finish(0, events);
    return events;
}

struct Decoded {
    std::vector<Step> steps;
    PulseDecoder decoder;
};

void decode(const std::vector<LineEvent>& events, Decoded& decoded) {
    for (const LineEvent& event : events)
        decoded.decoder.write(event.time_ns, event.levels, [&](const DecodedStep& step) {
            decoded.steps.push_back(
                {step.time_ns, static_cast<std::uint8_t>(step.axis), step.positive});
        });
}

void check_times_of_driver(const PulseDecoder& decoder) {
    for (std::size_t i = 0; i < config::axis_count; ++i) {
        const PulseFigures figures = decoder.figures(i);
        if (figures.shortest_high_ns) CHECK(*figures.shortest_high_ns >= driver_timing.high_ns);
        if (figures.shortest_low_ns) CHECK(*figures.shortest_low_ns >= driver_timing.low_ns);
        if (figures.shortest_setup_ns)
            CHECK(*figures.shortest_setup_ns >= driver_timing.direction_setup_ns);
        if (figures.shortest_hold_ns)
            CHECK(*figures.shortest_hold_ns >= driver_timing.direction_hold_ns);
    }
}

// Steps at random times, often at the same one, with random reversals.
std::vector<Step> random_steps(std::size_t count, std::int64_t mean_gap_ns, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Step> steps;
    std::int64_t time_ns = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (random() % 3) time_ns += static_cast<std::int64_t>(random()) % (2 * mean_gap_ns);
        steps.push_back({time_ns, static_cast<std::uint8_t>(random() % 4), random() % 5 != 0});
    }
    return steps;
}

}  // namespace

TEST_CASE("schedule 1: slow steps come exactly at their times") {
    std::vector<Step> steps;
    for (int i = 0; i < 100; ++i)
        steps.push_back({i * 10'000, static_cast<std::uint8_t>(i % 4), (i / 10) % 2 == 0});
    PulseSchedule schedule(driver_timing, 0);
    Decoded decoded;
    decode(schedule_all(steps, schedule), decoded);
    CHECK(schedule.shift_ns() == 0);
    REQUIRE(decoded.steps.size() == steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
        CHECK(decoded.steps[i].time_ns == steps[i].time_ns);
        CHECK(decoded.steps[i].axis == steps[i].axis);
        CHECK(decoded.steps[i].positive == steps[i].positive);
    }
    check_times_of_driver(decoded.decoder);
}

TEST_CASE(
    "schedule 1, 2, 3, decoder 1, 2: random steps keep order, number and the driver's times") {
    for (const std::int64_t mean_gap_ns : {200, 1'500, 4'000, 40'000}) {
        const std::vector<Step> steps = random_steps(20'000, mean_gap_ns, 5);
        PulseSchedule schedule(driver_timing, 0);
        Decoded decoded;
        decode(schedule_all(steps, schedule), decoded);
        REQUIRE(decoded.steps.size() == steps.size());
        // Steps of one nanosecond come in the order of axes.
        std::vector<std::vector<bool>> sent(4), received(4);
        std::int64_t last_shift_ns = 0;
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            sent[steps[i].axis].push_back(steps[i].positive);
            received[decoded.steps[i].axis].push_back(decoded.steps[i].positive);
            const std::int64_t shift_ns = decoded.steps[i].time_ns - steps[i].time_ns;
            wrong += shift_ns < last_shift_ns;
            last_shift_ns = shift_ns;
        }
        CHECK(wrong == 0);
        CHECK(sent == received);
        CHECK(last_shift_ns == schedule.shift_ns());
        check_times_of_driver(decoded.decoder);
    }
}

TEST_CASE("schedule 3: the shifts listed say how late each step is") {
    const std::vector<Step> steps = random_steps(5'000, 3'000, 9);
    PulseSchedule schedule(driver_timing, 0);
    Decoded decoded;
    decode(schedule_all(steps, schedule), decoded);
    const std::vector<Shift> shifts = schedule.take_shifts();
    REQUIRE_FALSE(shifts.empty());
    CHECK(schedule.take_shifts().empty());
    std::size_t next = 0, wrong = 0;
    std::int64_t shift_ns = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        while (next < shifts.size() && shifts[next].from_ns <= decoded.steps[i].time_ns)
            shift_ns = shifts[next++].shift_ns;
        wrong += decoded.steps[i].time_ns - steps[i].time_ns != shift_ns;
    }
    CHECK(wrong == 0);
    CHECK(next == shifts.size());
}

TEST_CASE(
    "schedule 4: events are in order, each nanosecond once, and keep the idle lines to the end") {
    const gpio::LineMask enable = gpio::line_bit(8) | gpio::line_bit(9);
    PulseSchedule schedule(driver_timing, enable);
    std::vector<LineEvent> events = schedule_all(random_steps(5'000, 2'000, 3), schedule);
    CHECK(events.back().levels == 0);
    CHECK(events.back().time_ns > events[events.size() - 2].time_ns);
    events.pop_back();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
        wrong += i > 0 && events[i].time_ns <= events[i - 1].time_ns;
        wrong += (events[i].levels & enable) != enable;
    }
    CHECK(wrong == 0);
}

TEST_CASE("schedule 4: steps of the same nanosecond leave in one event") {
    PulseSchedule schedule(driver_timing, 0);
    const std::vector<LineEvent> events =
        schedule_all({{9'000, 0, false}, {9'000, 1, false}, {9'000, 3, false}}, schedule);
    REQUIRE(events.size() == 2);
    CHECK(events[0].levels == (step_bit(0) | step_bit(1) | step_bit(3)));
    CHECK(events[1].time_ns == 11'000);
    CHECK(events[1].levels == 0);
}

TEST_CASE("schedule 2: what ends as it began leaves direction lines steady for what comes next") {
    const gpio::LineMask idle = direction_bit(0) | gpio::line_bit(8);
    PulseSchedule schedule(driver_timing, idle);
    std::vector<LineEvent> events;
    schedule.begin(0, events);
    schedule.append(std::vector<Step>{{50'000, 0, false}, {60'000, 1, true}}, events);
    schedule.finish_as_begun(events);
    REQUIRE(events.size() > 4);
    CHECK(events.front().levels == idle);
    // The last turns are followed by the time that a driver needs before a step.
    std::size_t turned = events.size() - 1;
    while (((events[turned].levels ^ events[turned - 1].levels) & all_direction_bits) == 0)
        --turned;
    CHECK(events[turned].levels == idle);
    CHECK(events.back().levels == idle);
    CHECK(events.back().time_ns - events[turned].time_ns >= driver_timing.direction_setup_ns);
}

TEST_CASE("schedule: appended in pieces of any size it gives the same events") {
    const std::vector<Step> steps = random_steps(3'000, 2'500, 17);
    PulseSchedule whole(driver_timing, 0);
    const std::vector<LineEvent> expected = schedule_all(steps, whole);
    PulseSchedule pieces(driver_timing, 0);
    std::vector<LineEvent> events;
    for (std::size_t i = 0; i < steps.size();) {
        const std::size_t size = std::min<std::size_t>(1 + i % 7, steps.size() - i);
        pieces.append(std::span(steps).subspan(i, size), events);
        i += size;
    }
    pieces.finish(0, events);
    REQUIRE(events.size() == expected.size());
    CHECK(std::equal(events.begin(), events.end(), expected.begin(),
                     [](const auto& a, const auto& b) {
                         return a.time_ns == b.time_ns && a.levels == b.levels;
                     }));
}

TEST_CASE(
    "schedule 4: marks that stand close, while drivers need long, all stay open and come out") {
    PulseSchedule schedule({100'000, 100'000, 500'000, 100'000, 5'000'000}, 0);
    constexpr std::uint64_t marks = 3'000;
    std::vector<LineEvent> events;
    schedule.begin(1'000'000, events);
    for (std::uint64_t i = 0; i < marks; ++i) {
        const auto time_ns = static_cast<std::int64_t>(i);
        const std::array<Step, 2> steps{
            {{time_ns, static_cast<std::uint8_t>(i % 4), true}, {time_ns, mark_axis, false}}};
        schedule.append(std::span(steps).last(i < 8 ? 2 : 1), events);
    }
    schedule.finish(0, events);
    std::uint64_t seen = 0, steps = 0;
    for (std::size_t i = 1; i < events.size(); ++i) {
        CHECK(events[i].time_ns > events[i - 1].time_ns);
        const gpio::LineMask toggled = events[i].levels ^ events[i - 1].levels;
        seen += (toggled & mark_bit) != 0;
        steps +=
            static_cast<std::uint64_t>(std::popcount(toggled & events[i].levels & all_step_bits));
    }
    CHECK(seen == marks);
    CHECK(steps == 8);
}

TEST_CASE("decoder 3: figures are the extremes of what was written") {
    PulseDecoder decoder;
    const auto write = [&](std::int64_t time_ns, gpio::LineMask levels) {
        decoder.write({time_ns, ~gpio::LineMask{0}, levels});
    };
    CHECK_FALSE(decoder.figures(1).shortest_interval_ns.has_value());
    write(0, direction_bit(1));
    write(1'000, direction_bit(1) | step_bit(1));
    write(1'300, direction_bit(1));
    write(5'000, direction_bit(1) | step_bit(1));
    write(5'900, direction_bit(1));
    write(6'000, 0);
    write(6'050, step_bit(1));
    write(9'000, 0);
    const PulseFigures figures = decoder.figures(1);
    CHECK(figures.steps == 3);
    CHECK(figures.reversals == 1);
    CHECK(decoder.positions()[1] == 1);
    CHECK(figures.shortest_interval_ns == 1'050);
    CHECK(figures.longest_interval_ns == 4'000);
    CHECK(figures.shortest_high_ns == 300);
    CHECK(figures.shortest_low_ns == 150);
    CHECK(figures.shortest_setup_ns == 50);
    CHECK(figures.shortest_hold_ns == 1'000);
    CHECK(decoder.writes() == 8);
}

TEST_CASE("decoder 2: a direction that changes with the step comes too late for it") {
    PulseDecoder decoder;
    decoder.write({10, ~gpio::LineMask{0}, step_bit(0) | direction_bit(0)});
    CHECK(decoder.positions()[0] == -1);
    CHECK(decoder.figures(0).shortest_hold_ns == 0);
}
