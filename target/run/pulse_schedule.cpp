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

// Seldom, so its code is here once.
[[gnu::noinline]] void add(std::vector<LineEvent>& events, LineEvent event) {
    events.push_back(event);
}

}  // namespace

PulseSchedule::PulseSchedule(const config::PulseTiming& timing, gpio::LineMask idle)
    : timing_(timing), idle_(idle), levels_(idle) {
    for (std::size_t i = 0; i < axes_.size(); ++i)
        axes_[i] = {long_ago_ns, long_ago_ns, (idle & direction_bit(i)) != 0};
}

void PulseSchedule::begin(std::int64_t delay_ns, std::vector<LineEvent>& events) {
    add(events, {0, levels_});
    delay(-delay_ns, 0);
}

[[gnu::always_inline]] inline void PulseSchedule::Open::emit_before(std::int64_t time_ns) {
    std::size_t emitted = 0;
    for (; emitted < count && edges[emitted].time_ns < time_ns; ++emitted) {
        levels ^= edges[emitted].toggled;
        *events++ = {edges[emitted].time_ns, levels};
    }
    count -= emitted;
    for (std::size_t i = 0; i < count; ++i) edges[i] = edges[emitted + i];
}

// What lies before the direction's edge is certain: no later step has any there.
[[gnu::always_inline]] inline void PulseSchedule::step(const Step& step, Open& open) {
    AxisState& axis = axes_[step.axis];
    const std::int64_t wanted_ns = step.time_ns + shift_ns_;
    std::int64_t rise_ns = std::max(wanted_ns, axis.fall_ns + timing_.low_ns);
    const bool turns = step.positive != axis.positive;
    if (turns)
        rise_ns = std::max(rise_ns,
                           axis.rise_ns + timing_.direction_hold_ns + timing_.direction_setup_ns);
    if (rise_ns > wanted_ns) delay(wanted_ns, rise_ns);
    open.emit_before(rise_ns - timing_.direction_setup_ns);
    if (turns) open.insert(rise_ns - timing_.direction_setup_ns, direction_bit(step.axis));
    axis = {rise_ns, rise_ns + timing_.high_ns, step.positive};
    open.insert(axis.rise_ns, step_bit(step.axis));
    open.insert(axis.fall_ns, step_bit(step.axis));
}

void PulseSchedule::append(std::span<const Step> steps, std::vector<LineEvent>& events) {
    constexpr std::size_t most_at_once = 64;
    while (!steps.empty()) {
        const auto now = steps.first(std::min(most_at_once, steps.size()));
        steps = steps.subspan(now.size());
        Open open = this->open(now.size());
        for (const Step& next : now) {
            if (next.axis == mark_axis)
                open = mark(next, open);
            else
                step(next, open);
        }
        close(open, events);
    }
}

PulseSchedule::Open PulseSchedule::open(std::size_t steps) {
    const std::size_t most = open_count_ + edges_of_step * steps;
    if (edges_.size() < most) {
        edges_.resize(most);
        events_.resize(most);
    }
    return {edges_.data(), open_count_, levels_, events_.data()};
}

void PulseSchedule::close(const Open& open, std::vector<LineEvent>& events) {
    events.insert(events.end(), events_.data(), open.events);
    open_count_ = open.count;
    levels_ = open.levels;
}

[[gnu::noinline]] void PulseSchedule::delay(std::int64_t wanted_ns, std::int64_t due_ns) {
    shift_ns_ += due_ns - wanted_ns;
    shifts_.push_back({due_ns, shift_ns_});
}

std::int64_t PulseSchedule::quiet_ns(std::int64_t from_ns) const {
    std::int64_t quiet_ns = from_ns;
    for (const AxisState& axis : axes_)
        quiet_ns = std::max({quiet_ns, axis.fall_ns, axis.rise_ns + timing_.direction_hold_ns});
    return quiet_ns;
}

PulseSchedule::Open PulseSchedule::mark(const Step& step, Open open) {
    const std::int64_t wanted_ns = std::max<std::int64_t>(0, step.time_ns + shift_ns_);
    const bool is_gate = step.positive;
    std::int64_t time_ns = std::max(wanted_ns, last_mark_ns_ + 1);
    // What falls at the gate itself would be written after it.
    if (is_gate) time_ns = std::max(time_ns, quiet_ns(0) + 1);
    if (time_ns > wanted_ns) delay(wanted_ns, time_ns);
    last_mark_ns_ = time_ns;
    open.insert(time_ns, is_gate ? all_mark_bits : mark_bit);
    open.emit_before(time_ns - timing_.direction_setup_ns);
    return open;
}

std::size_t PulseSchedule::insert_between(Edge* edges, std::size_t count, Edge edge) {
    std::size_t place = count;
    while (place > 0 && edges[place - 1].time_ns > edge.time_ns) --place;
    if (place > 0 && edges[place - 1].time_ns == edge.time_ns) {
        edges[place - 1].toggled ^= edge.toggled;
        return count;
    }
    std::copy_backward(edges + place, edges + count, edges + count + 1);
    edges[place] = edge;
    return count + 1;
}

void PulseSchedule::emit_before(std::int64_t time_ns, std::vector<LineEvent>& events) {
    Open open = this->open(0);
    open.emit_before(time_ns);
    close(open, events);
}

void PulseSchedule::finish(std::int64_t end_ns, std::vector<LineEvent>& events) {
    const std::int64_t last_ns = std::max(quiet_ns(end_ns + shift_ns_), last_mark_ns_ + 1);
    emit_before(last_ns, events);
    open_count_ = 0;
    levels_ &= all_mark_bits;
    add(events, {last_ns, levels_});
}

void PulseSchedule::finish_as_begun(std::vector<LineEvent>& events) {
    const std::int64_t last_ns = quiet_ns(0);
    emit_before(last_ns, events);
    open_count_ = 0;
    levels_ = idle_;
    add(events, {last_ns, levels_});
    add(events, {last_ns + timing_.direction_setup_ns, levels_});
}

std::vector<Shift> PulseSchedule::take_shifts() {
    return std::exchange(shifts_, {});
}

}  // namespace lyr::run
