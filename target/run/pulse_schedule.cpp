// A step's direction edge may lie before edges of other axes that are known already, by no more than
// the set-up time. So edges wait in a short sorted list until the steps are that much further.

#include "target/run/pulse_schedule.h"

#include <algorithm>
#include <utility>

namespace lyr::run {
namespace {

// Before the first step of an axis nothing of it has happened for a long time.
constexpr std::int64_t long_ago_ns = -3'600'000'000'000;

constexpr std::size_t edges_of_step = 3;

}  // namespace

PulseSchedule::PulseSchedule(const config::PulseTiming& timing, gpio::LineMask idle)
    : timing_(timing), idle_(idle), levels_(idle) {
    for (std::size_t i = 0; i < axes_.size(); ++i)
        axes_[i] = {long_ago_ns, long_ago_ns, (idle & direction_bit(i)) != 0};
    open_.resize(2 * edges_of_step * config::axis_count);
}

void PulseSchedule::begin(std::int64_t delay_ns, std::vector<LineEvent>& events) {
    events.push_back({0, levels_});
    shift_ns_ += delay_ns;
    shifts_.push_back({0, shift_ns_});
}

void PulseSchedule::append(std::span<const Step> steps, std::vector<LineEvent>& events) {
    for (const Step& next : steps) {
        if (next.axis == mark_axis)
            mark(next, events);
        else
            step(next, events);
    }
}

// What lies before the direction's edge is certain: no later step has any there.
void PulseSchedule::step(const Step& step, std::vector<LineEvent>& events) {
    make_room();
    AxisState& axis = axes_[step.axis];
    const std::int64_t wanted_ns = step.time_ns + shift_ns_;
    std::int64_t rise_ns = std::max(wanted_ns, axis.fall_ns + timing_.low_ns);
    const bool turns = step.positive != axis.positive;
    if (turns)
        rise_ns = std::max(rise_ns,
                           axis.rise_ns + timing_.direction_hold_ns + timing_.direction_setup_ns);
    delay(wanted_ns, rise_ns);
    emit_before(rise_ns - timing_.direction_setup_ns, events);
    if (turns) insert(rise_ns - timing_.direction_setup_ns, direction_bit(step.axis));
    axis = {rise_ns, rise_ns + timing_.high_ns, step.positive};
    insert(axis.rise_ns, step_bit(step.axis));
    insert(axis.fall_ns, step_bit(step.axis));
}

void PulseSchedule::delay(std::int64_t wanted_ns, std::int64_t due_ns) {
    if (due_ns <= wanted_ns) return;
    shift_ns_ += due_ns - wanted_ns;
    shifts_.push_back({due_ns, shift_ns_});
}

std::int64_t PulseSchedule::quiet_ns(std::int64_t from_ns) const {
    std::int64_t quiet_ns = from_ns;
    for (const AxisState& axis : axes_)
        quiet_ns = std::max({quiet_ns, axis.fall_ns, axis.rise_ns + timing_.direction_hold_ns});
    return quiet_ns;
}

void PulseSchedule::mark(const Step& step, std::vector<LineEvent>& events) {
    make_room();
    const std::int64_t wanted_ns = std::max<std::int64_t>(0, step.time_ns + shift_ns_);
    const bool is_gate = step.positive;
    std::int64_t time_ns = std::max(wanted_ns, last_mark_ns_ + 1);
    // What falls at the gate itself would be written after it.
    if (is_gate) time_ns = std::max(time_ns, quiet_ns(0) + 1);
    delay(wanted_ns, time_ns);
    last_mark_ns_ = time_ns;
    insert(time_ns, is_gate ? all_mark_bits : mark_bit);
    emit_before(time_ns - timing_.direction_setup_ns, events);
}

void PulseSchedule::make_room() {
    if (open_.size() - open_count_ < edges_of_step) open_.resize(2 * open_.size());
}

void PulseSchedule::insert_between(std::int64_t time_ns, gpio::LineMask toggled) {
    std::size_t place = open_count_;
    while (place > 0 && open_[place - 1].time_ns > time_ns) --place;
    if (place > 0 && open_[place - 1].time_ns == time_ns) {
        open_[place - 1].toggled ^= toggled;
        return;
    }
    const auto from = open_.begin() + static_cast<std::ptrdiff_t>(place);
    const auto end = open_.begin() + static_cast<std::ptrdiff_t>(open_count_++);
    std::copy_backward(from, end, end + 1);
    *from = {time_ns, toggled};
}

void PulseSchedule::emit_before(std::int64_t time_ns, std::vector<LineEvent>& events) {
    gpio::LineMask levels = levels_;
    std::size_t count = 0;
    for (; count < open_count_ && open_[count].time_ns < time_ns; ++count) {
        levels ^= open_[count].toggled;
        events.push_back({open_[count].time_ns, levels});
    }
    levels_ = levels;
    for (std::size_t i = count; i < open_count_; ++i) open_[i - count] = open_[i];
    open_count_ -= count;
}

void PulseSchedule::finish(std::int64_t end_ns, std::vector<LineEvent>& events) {
    const std::int64_t last_ns = std::max(quiet_ns(end_ns + shift_ns_), last_mark_ns_ + 1);
    emit_before(last_ns, events);
    open_count_ = 0;
    levels_ &= all_mark_bits;
    events.push_back({last_ns, levels_});
}

void PulseSchedule::finish_as_begun(std::vector<LineEvent>& events) {
    const std::int64_t last_ns = quiet_ns(0);
    emit_before(last_ns, events);
    open_count_ = 0;
    levels_ = idle_;
    events.push_back({last_ns, levels_});
    events.push_back({last_ns + timing_.direction_setup_ns, levels_});
}

std::vector<Shift> PulseSchedule::take_shifts() {
    return std::exchange(shifts_, {});
}

}  // namespace lyr::run
