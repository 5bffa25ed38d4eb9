// What Executor does for each event, for whoever binds it to a chip and a clock.

#pragma once

#include <algorithm>
#include <bit>

#include "target/run/executor.h"

namespace lyr::run {

template <class Chip, class Timer>
Result<bool> Executor::run(std::span<const LineEvent> events) {
    taken_ = 0;
    if (events.empty()) return true;
    if (!started_ && !on_trip_ && target_pace() == 0) return false;
    if (rebased_) start(events.front());
    for (const auto& [time_ns, planned_levels] : events) {
        gpio::LineMask levels = planned_levels, falls = 0;
        if (ended_ != 0 && !on_trip_) {
            falls = ended_ & ~levels;
            levels &= ~ended_;
        }
        std::int64_t gap_ns = time_ns - last_event_ns_;
        if (const float target = target_pace(); target != 1 || pace_ != 1) {
            const std::optional<std::int64_t> paced_ns = paced_gap_ns(gap_ns, target);
            if (!paced_ns) return rest();
            gap_ns = *paced_ns;
        }
        const std::int64_t due_ns = last_begin_ns_ + gap_ns;
        const std::int64_t allowed_ns =
            std::max(due_ns, last_end_ns_ + std::min(gap_ns, timing_.edge_gap_ns));
        if (allowed_ns - last_end_ns_ > wait_slice_ns && !wait_for_last_slice(allowed_ns))
            return rest();
        const std::int64_t begin_ns = static_cast<Timer&>(clock_).wait_until_ns(allowed_ns);
        const std::int64_t late_ns = begin_ns - due_ns;
        worst_late_ns_ = std::max(worst_late_ns_, late_ns);
        // Only steps move the head: the end of a pulse or a turn that comes late must not slow it down.
        const bool is_step = (levels & ~levels_ & all_step_bits) != 0;
        if (is_step) stretched_ns_ += late_ns;
        if (late_ns > timing_.late_limit_ns) return too_late(late_ns);
        last_begin_ns_ = is_step ? begin_ns : due_ns;
        if (((levels ^ levels_) & all_mark_bits) && !pass_mark(levels)) return rest();
        if (Status written = write<Chip, Timer>({time_ns, levels}, falls); !written)
            return written.error();
        ++taken_;
    }
    return true;
}

inline float Executor::target_pace() const {
    if (stop_requests_.load(std::memory_order_relaxed) != 0) return 0;
    if (!wanted_pace_ || on_trip_) return 1;
    return wanted_pace_->load(std::memory_order_relaxed);
}

template <class Chip, class Timer>
Status Executor::write(LineEvent event, gpio::LineMask falls) {
    const gpio::LineMask toggled = levels_ ^ event.levels;
    const gpio::LineMask lines = toggled & ~all_mark_bits;
    const bool is_written = lines != 0 || (toggled == 0 && falls == 0);
    if (!on_trip_) behind_ns_ = last_begin_ns_ - event.time_ns;
    Status written = is_written ? static_cast<Chip&>(chip_).write(lines, event.levels) : Done{};
    last_end_ns_ = static_cast<Timer&>(clock_).now_ns();
    last_event_ns_ = event.time_ns;
    levels_ = event.levels;
    ended_ &= ~falls;
    count(toggled, event.levels);
    if (is_written) ++writes_;
    return written;
}

inline void Executor::count(gpio::LineMask toggled, gpio::LineMask levels) {
    StepPositions& positions = on_trip_ ? trip_steps_ : positions_;
    for (gpio::LineMask rising = toggled & levels & all_step_bits; rising; rising &= rising - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rising)) / 2;
        positions[axis] += (levels & direction_bit(axis)) != 0 ? 1 : -1;
    }
}

}  // namespace lyr::run
