// What Executor does for each event, for whoever binds it to a chip and a clock. Times are kept as gaps from the write
// before, so that the lateness of a step adds to everything that follows by itself and nothing ever has to be caught up.

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
    StepPositions& positions = on_trip_ ? trip_steps_ : positions_;
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
        const gpio::LineMask toggled = levels ^ levels_, rises = toggled & levels & all_step_bits;
        if (rises) stretched_ns_ += late_ns;
        if (late_ns > timing_.late_limit_ns) return too_late(late_ns);
        last_begin_ns_ = rises ? begin_ns : due_ns;
        if ((toggled & all_mark_bits) && !pass_mark(toggled)) return rest();
        const gpio::LineMask lines = toggled & ~all_mark_bits;
        const bool is_written = lines != 0 || (toggled == 0 && falls == 0);
        if (!on_trip_) behind_ns_ = last_begin_ns_ - time_ns;
        Status written = is_written ? static_cast<Chip&>(chip_).write(lines, levels) : Done{};
        last_end_ns_ = static_cast<Timer&>(clock_).now_ns();
        last_event_ns_ = time_ns;
        levels_ = levels;
        ended_ &= ~falls;
        count(rises, levels, positions);
        writes_ += is_written;
        if (!written) return written.error();
        ++taken_;
    }
    return true;
}

inline float Executor::target_pace() const {
    if (stop_requests_.load(std::memory_order_relaxed) != 0) return 0;
    if (!wanted_pace_ || on_trip_) return 1;
    return wanted_pace_->load(std::memory_order_relaxed);
}

inline void Executor::count(gpio::LineMask rises, gpio::LineMask levels, StepPositions& positions) {
    for (; rises; rises &= rises - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rises)) / 2;
        positions[axis] += (levels & direction_bit(axis)) != 0 ? 1 : -1;
    }
}

}  // namespace lyr::run
