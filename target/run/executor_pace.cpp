// What the executor does now and then: trips, braking, rests and marks.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/constants.h"
#include "target/run/executor.h"
#include "target/run/executor_loop.h"

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

}  // namespace

std::int64_t braking_ns(const config::Axis& axis, double speed_mm_s) {
    return std::llround(braking_margin * std::min(speed_mm_s, axis.max_speed_mm_s) /
                        axis.max_acceleration_mm_s2 * ns_per_s);
}

ExecutorTiming executor_timing(const config::Printer& printer) {
    const config::PulseTiming& pulse = printer.pulse;
    std::int64_t longest_ns = 0;
    for (const config::Axis& axis : printer.axes)
        longest_ns = std::max(longest_ns, braking_ns(axis, axis.max_speed_mm_s));
    return {
        std::max({pulse.high_ns, pulse.low_ns, pulse.direction_setup_ns, pulse.direction_hold_ns}),
        pulse.late_limit_ns, longest_ns};
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
    if (on_trip_) return;
    started_ = true;
    begun_behind_ns_ = last_begin_ns_ - event.time_ns;
}

bool Executor::wait_for_last_slice(std::int64_t time_ns) {
    std::int64_t now_ns = last_end_ns_;
    for (; time_ns - now_ns > wait_slice_ns; now_ns = clock_.wait_until_ns(now_ns + wait_slice_ns))
        if (target_pace() == 0) return false;
    return true;
}

std::optional<std::int64_t> Executor::paced_gap_ns(std::int64_t gap_ns, float wanted) {
    const double target = static_cast<double>(wanted);
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

bool Executor::pass_mark(gpio::LineMask toggled) {
    if (!at_gate_) ++marks_reached_;
    if (!marks_) return true;
    marks_->reached.store(marks_reached_, std::memory_order_release);
    if (!(toggled & gate_bit)) return true;
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

Diagnostic Executor::too_late(std::int64_t late_ns) const {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "an edge came %.3f ms late (the limit is pulse.late_limit_ms = %.3f): the printer has "
        "stopped, and its position is lost; free the processor or lower the speeds",
        static_cast<double>(late_ns) / 1e6, static_cast<double>(timing_.late_limit_ns) / 1e6);
    return machine_error(text);
}

}  // namespace lyr::run
