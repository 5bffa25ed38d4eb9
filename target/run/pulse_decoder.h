// Reads step and direction lines as a motor driver does: each rising edge of a step line moves the axis
// by one step in the direction that the direction line has at that moment. Knows nothing of how the
// edges came about, and so can judge them. What is done for each edge stands here, since there are
// hundreds of millions in a simulation.
//
// Contract
//  1. Positions count from 0 at the first write; +1 for a rising edge under an active direction line,
//     -1 under an inactive one.
//  2. Every step is told to the observer once, in order of time; steps of one write in order of axes.
//     Lines that change in the same write as the direction line see it as it was before.
//  3. The figures of an axis are the extremes over all that was written. What did not occur is none.

#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>

#include "target/gpio/mock_chip.h"
#include "target/run/line_layout.h"

namespace lyr::run {

using StepPositions = std::array<std::int64_t, config::axis_count>;

struct DecodedStep {
    std::int64_t time_ns = 0;
    std::size_t axis = 0;
    const StepPositions& before;
    bool positive = true;
};

// Of one axis.
struct PulseFigures {
    std::uint64_t steps = 0;
    std::uint64_t reversals = 0;
    std::optional<std::int64_t> shortest_interval_ns, longest_interval_ns;  // rise to rise
    std::optional<std::int64_t> shortest_high_ns, shortest_low_ns;
    std::optional<std::int64_t> shortest_setup_ns, shortest_hold_ns;
};

class PulseDecoder {
public:
    // All lines have these levels from now on; times ascend. `observe` is called with each DecodedStep.
    template <class Observer>
    void write(std::int64_t time_ns, gpio::LineMask levels, const Observer& observe);
    void write(const gpio::LineWrite& line_write) {
        write(line_write.time_ns, line_write.levels, [](const DecodedStep&) {});
    }

    const StepPositions& positions() const { return positions_; }
    PulseFigures figures(std::size_t axis) const;
    std::uint64_t writes() const { return writes_; }

private:
    // So long ago that no interval from there is a shortest one; and the shortest so far where there is none.
    static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::min() / 4;
    static constexpr std::int64_t none_ns = std::numeric_limits<std::int64_t>::max() / 8;

    struct Shortest {
        std::int64_t ns = none_ns;
        void keep(std::int64_t duration_ns) { ns = std::min(ns, duration_ns); }
    };
    // Of a size that an index is shifted by, not multiplied with.
    struct alignas(128) AxisState {
        std::uint64_t steps = 0, reversals = 0;
        std::int64_t rise_ns = never_ns, fall_ns = never_ns;
        std::int64_t turn_ns = never_ns;  // if it was after the last rise
        std::int64_t longest_interval_ns = -1;
        Shortest interval, high, low, setup, hold;
        bool last_positive = false;
    };

    // Whether that is a step upwards.
    bool rise(std::size_t axis, std::int64_t time_ns);
    static void fall(AxisState& state, std::int64_t time_ns) {
        state.high.keep(time_ns - state.rise_ns);
        state.fall_ns = time_ns;
    }
    static void turn(AxisState& state, std::int64_t time_ns) {
        if (state.turn_ns == never_ns) state.hold.keep(time_ns - state.rise_ns);
        state.turn_ns = time_ns;
    }

    gpio::LineMask levels_ = 0;
    StepPositions positions_{};
    std::array<AxisState, config::axis_count> axes_;
    std::uint64_t writes_ = 0;
};

template <class Observer>
[[gnu::always_inline]] inline void PulseDecoder::write(std::int64_t time_ns, gpio::LineMask levels,
                                                       const Observer& observe) {
    const auto axis_of_lowest = [](gpio::LineMask bits) {
        return static_cast<std::size_t>(std::countr_zero(bits)) / 2;
    };
    ++writes_;
    const gpio::LineMask edges = levels_ ^ levels, steps = edges & all_step_bits;
    for (gpio::LineMask falls = steps & ~levels; falls; falls &= falls - 1)
        fall(axes_[axis_of_lowest(falls)], time_ns);
    for (gpio::LineMask rises = steps & levels; rises; rises &= rises - 1) {
        const std::size_t axis = axis_of_lowest(rises);
        const bool positive = rise(axis, time_ns);
        observe(DecodedStep{time_ns, axis, positions_, positive});
        positions_[axis] += positive ? 1 : -1;
    }
    for (gpio::LineMask turns = edges & all_direction_bits; turns; turns &= turns - 1)
        turn(axes_[axis_of_lowest(turns)], time_ns);
    levels_ = levels;
}

inline bool PulseDecoder::rise(std::size_t axis, std::int64_t time_ns) {
    AxisState& state = axes_[axis];
    const bool positive = (levels_ & direction_bit(axis)) != 0;
    if (state.steps != 0) {
        const std::int64_t interval_ns = time_ns - state.rise_ns;
        state.interval.keep(interval_ns);
        state.longest_interval_ns = std::max(state.longest_interval_ns, interval_ns);
        if (state.last_positive != positive) ++state.reversals;
    }
    state.low.keep(time_ns - state.fall_ns);
    if (state.turn_ns != never_ns) {
        state.setup.keep(time_ns - state.turn_ns);
        state.turn_ns = never_ns;
    }
    ++state.steps;
    state.rise_ns = time_ns;
    state.last_positive = positive;
    return positive;
}

}  // namespace lyr::run
