// Times are kept as gaps from the write before, so that the lateness of a step adds to everything that follows by
// itself and nothing ever has to be caught up.

#include "target/run/executor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "base/constants.h"

namespace lyr::run {
namespace {

// Below this share of its planned speed the head may stop dead: motors start and stop without a ramp
// at speeds of a few mm/s.
constexpr double rest_pace = 0.02;
// Where steps are further apart than this, the head as good as stands.
constexpr std::int64_t standing_ns = 20'000'000;

// Braking adds to the acceleration that the path itself asks for at the time; taking this much longer
// than the slowest axis needs leaves room for both.
constexpr double braking_margin = 2;

Diagnostic too_late(std::int64_t late_ns, std::int64_t limit_ns) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "an edge came %.3f ms late (the limit is pulse.late_limit_ms = %.3f): the printer has "
        "stopped, and its position is lost; free the processor or lower the speeds",
        static_cast<double>(late_ns) / 1e6, static_cast<double>(limit_ns) / 1e6);
    return {Severity::error, ExitStatus::machine, text, {}};
}

}  // namespace

ExecutorTiming executor_timing(const config::Printer& printer) {
    const config::PulseTiming& pulse = printer.pulse;
    double longest_s = 0;
    for (const config::Axis& axis : printer.axes)
        longest_s = std::max(longest_s, axis.max_speed_mm_s / axis.max_acceleration_mm_s2);
    return {
        std::max({pulse.high_ns, pulse.low_ns, pulse.direction_setup_ns, pulse.direction_hold_ns}),
        pulse.late_limit_ns, std::llround(braking_margin * longest_s * ns_per_s)};
}

Result<bool> Executor::execute(std::span<const LineEvent> events) {
    return run(events);
}

void Executor::begin_trip() {
    path_ns_ = last_event_ns_;
    on_trip_ = rebased_ = true;
    pace_ = 1;
}

void Executor::end_trip() {
    on_trip_ = false;
    last_event_ns_ = path_ns_;
    go_on();
}

void Executor::go_on() {
    rebased_ = true;
    pace_ = started_ ? rest_pace : 1;
}

Result<bool> Executor::run(std::span<const LineEvent> events) {
    taken_ = 0;
    for (LineEvent event : events) {
        if (!started_ && !on_trip_ && target_pace() == 0) return false;
        if (rebased_) start(event);
        const gpio::LineMask ended = on_trip_ ? 0 : ended_;
        const gpio::LineMask falls = ended & ~event.levels;
        event.levels &= ~ended;
        const std::int64_t planned_gap_ns = event.time_ns - last_event_ns_;
        const std::optional<std::int64_t> gap_ns = paced_gap_ns(planned_gap_ns);
        if (!gap_ns) return rest();
        const std::int64_t due_ns = last_begin_ns_ + *gap_ns;
        const std::int64_t allowed_ns =
            std::max(due_ns, last_end_ns_ + std::min(*gap_ns, timing_.edge_gap_ns));
        const std::optional<std::int64_t> begin_ns = wait_until_ns(allowed_ns);
        if (!begin_ns) return rest();
        const std::int64_t late_ns = *begin_ns - due_ns;
        worst_late_ns_ = std::max(worst_late_ns_, late_ns);
        // Only steps move the head: the end of a pulse or a turn that comes late must not slow it down.
        const bool is_step = (event.levels & ~levels_ & all_step_bits) != 0;
        if (is_step) stretched_ns_ += late_ns;
        if (late_ns > timing_.late_limit_ns) return too_late(late_ns, timing_.late_limit_ns);
        last_begin_ns_ = is_step ? *begin_ns : due_ns;
        if (((event.levels ^ levels_) & all_mark_bits) && !pass_mark(event)) return rest();
        if (Status written = write(event, falls); !written) return written.error();
        ++taken_;
    }
    return true;
}

Result<bool> Executor::rest() {
    const gpio::LineMask out = levels_ & all_step_bits;
    if (!out) return false;
    clock_.wait_until_ns(last_end_ns_ + timing_.edge_gap_ns);
    if (Status written = chip_.write(out, levels_ & ~out); !written) return written.error();
    last_end_ns_ = clock_.now_ns();
    levels_ &= ~out;
    if (!on_trip_) ended_ |= out;
    ++writes_;
    return false;
}

void Executor::start(const LineEvent& event) {
    rebased_ = false;
    last_begin_ns_ = last_end_ns_ = clock_.now_ns();
    if (!on_trip_ && started_) return;
    last_event_ns_ = event.time_ns;
    started_ = started_ || !on_trip_;
}

double Executor::target_pace() const {
    if (stop_requests_.load(std::memory_order_relaxed) != 0) return 0;
    if (!wanted_pace_ || on_trip_) return 1;
    return static_cast<double>(wanted_pace_->load(std::memory_order_relaxed));
}

std::optional<std::int64_t> Executor::paced_gap_ns(std::int64_t gap_ns) {
    const double target = target_pace();
    if (target == 1 && pace_ == 1) return gap_ns;
    const bool stands = gap_ns > standing_ns;
    if (target == 0) {
        const bool at_once = stop_requests_.load(std::memory_order_relaxed) > 1;
        if (at_once || pace_ <= rest_pace || stands) return std::nullopt;
    } else if (stands) {
        pace_ = target;
        return gap_ns;
    }
    const double paced_ns = static_cast<double>(gap_ns) / pace_;
    const double change =
        paced_ns / static_cast<double>(std::max<std::int64_t>(1, timing_.braking_ns));
    pace_ = pace_ > target ? std::max({target, rest_pace, pace_ - change})
                           : std::min(target, pace_ + change);
    return std::llround(paced_ns);
}

std::optional<std::int64_t> Executor::wait_until_ns(std::int64_t time_ns) {
    std::int64_t now_ns = last_end_ns_;
    while (time_ns - now_ns > wait_slice_ns) {
        if (target_pace() == 0) return std::nullopt;
        now_ns = clock_.wait_until_ns(now_ns + wait_slice_ns);
    }
    return clock_.wait_until_ns(time_ns);
}

bool Executor::pass_mark(const LineEvent& event) {
    if (!at_gate_) ++marks_reached_;
    if (!marks_) return true;
    marks_->reached.store(marks_reached_, std::memory_order_release);
    if (!((event.levels ^ levels_) & gate_bit)) return true;
    const std::int64_t from_ns = clock_.now_ns();
    std::int64_t now_ns = from_ns;
    const auto is_open = [&] {
        return marks_->done.load(std::memory_order_acquire) == marks_reached_;
    };
    while (!is_open() && target_pace() > 0) now_ns = clock_.wait_until_ns(now_ns + wait_slice_ns);
    at_gate_ = !is_open();
    waited_ns_ += now_ns - from_ns;
    last_begin_ns_ = now_ns;
    return !at_gate_;
}

Status Executor::write(const LineEvent& event, gpio::LineMask falls) {
    const gpio::LineMask toggled = levels_ ^ event.levels;
    const gpio::LineMask lines = toggled & ~all_mark_bits;
    const bool is_written = lines != 0 || (toggled == 0 && falls == 0);
    if (!on_trip_) behind_ns_ = last_begin_ns_ - event.time_ns;
    Status written = is_written ? chip_.write(lines, event.levels) : Done{};
    last_end_ns_ = clock_.now_ns();
    last_event_ns_ = event.time_ns;
    levels_ = event.levels;
    ended_ &= ~falls;
    count(toggled, event.levels);
    if (is_written) ++writes_;
    return written;
}

void Executor::count(gpio::LineMask toggled, gpio::LineMask levels) {
    StepPositions& positions = on_trip_ ? trip_steps_ : positions_;
    for (gpio::LineMask rising = toggled & levels & all_step_bits; rising; rising &= rising - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rising)) / 2;
        positions[axis] += (levels & direction_bit(axis)) != 0 ? 1 : -1;
    }
}

}  // namespace lyr::run
