// One pass over the changed bits of each write.

#include "target/run/pulse_decoder.h"

#include <algorithm>
#include <bit>

namespace lyr::run {
namespace {

void keep_shortest(std::optional<std::int64_t>& shortest, std::int64_t duration_ns) {
    if (!shortest || duration_ns < *shortest) shortest = duration_ns;
}

void keep_longest(std::optional<std::int64_t>& longest, std::int64_t duration_ns) {
    if (!longest || duration_ns > *longest) longest = duration_ns;
}

std::size_t axis_of_lowest(gpio::LineMask bits) {
    return static_cast<std::size_t>(std::countr_zero(bits)) / 2;
}

}  // namespace

void PulseDecoder::write(const gpio::LineWrite& write) {
    ++writes_;
    const gpio::LineMask edges = levels_ ^ write.levels;
    for (gpio::LineMask steps = edges & all_step_bits; steps; steps &= steps - 1) {
        const std::size_t axis = axis_of_lowest(steps);
        if (write.levels & step_bit(axis))
            rise(axis, write.time_ns);
        else
            fall(axes_[axis], write.time_ns);
    }
    for (gpio::LineMask turns = edges & all_direction_bits; turns; turns &= turns - 1)
        turn(axes_[axis_of_lowest(turns)], write.time_ns);
    levels_ = write.levels;
}

void PulseDecoder::rise(std::size_t axis, std::int64_t time_ns) {
    AxisState& state = axes_[axis];
    PulseFigures& figures = state.figures;
    const bool positive = (levels_ & direction_bit(axis)) != 0;
    if (state.rise_ns) {
        keep_shortest(figures.shortest_interval_ns, time_ns - *state.rise_ns);
        keep_longest(figures.longest_interval_ns, time_ns - *state.rise_ns);
    }
    if (state.fall_ns) keep_shortest(figures.shortest_low_ns, time_ns - *state.fall_ns);
    if (state.turn_ns) keep_shortest(figures.shortest_setup_ns, time_ns - *state.turn_ns);
    if (state.last_positive && *state.last_positive != positive) ++figures.reversals;
    ++figures.steps;
    state.rise_ns = time_ns;
    state.hold_open = true;
    state.last_positive = positive;
    if (observer_) observer_({time_ns, axis, positions_, positive});
    positions_[axis] += positive ? 1 : -1;
}

void PulseDecoder::fall(AxisState& state, std::int64_t time_ns) {
    if (state.rise_ns) keep_shortest(state.figures.shortest_high_ns, time_ns - *state.rise_ns);
    state.fall_ns = time_ns;
}

void PulseDecoder::turn(AxisState& state, std::int64_t time_ns) {
    if (state.hold_open) keep_shortest(state.figures.shortest_hold_ns, time_ns - *state.rise_ns);
    state.hold_open = false;
    state.turn_ns = time_ns;
}

}  // namespace lyr::run
