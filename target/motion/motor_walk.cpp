// A rising half wave is a falling one seen in a mirror: with `heading_` the cosine mirrored as
// well, all spans are solved as falling ones.

#include "target/motion/motor_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lyr::motion {
namespace {

using std::numbers::pi;

}  // namespace

void MotorWalk::start(const MotorPath& path, double length_mm, std::int64_t count) {
    length_mm_ = length_mm;
    count_ = count;
    std::visit([this](const auto& function) { begin(function); }, path);
}

void MotorWalk::begin(const Linear& line) {
    turns_ = false;
    direction_ = line.rate > 0 ? 1 : line.rate < 0 ? -1 : 0;
    span_begin_ = line.start;
    span_end_ = line.start + line.rate * length_mm_;
    mm_per_step_ = direction_ ? 1 / line.rate : 0;
}

void MotorWalk::begin(const Harmonic& turning) {
    turns_ = true;
    amplitude_ = turning.amplitude;
    mm_per_rad_ = 1 / turning.rate;
    sweep_rad_ = turning.rate * length_mm_;
    const bool falls = turning.phase_rad < pi;
    direction_ = falls ? -1 : 1;
    begin_rad_ = 0;
    to_turn_rad_ = (falls ? pi : 2 * pi) - turning.phase_rad;
    sine_ = std::abs(std::sin(turning.phase_rad));
    heading_ = (falls ? 1 : -1) * std::cos(turning.phase_rad);
    span_begin_ = turning.start;
    measure_span();
}

// From the begin to the turning point the cosine falls by 1 + heading, to the end of the move by
// 2 sin(middle) sin(half the angle).
void MotorWalk::measure_span() {
    const double left_rad = sweep_rad_ - begin_rad_;
    double fall = heading_ < 0 ? sine_ * sine_ / (1 - heading_) : 1 + heading_;
    if (left_rad < to_turn_rad_) {
        const double half_rad = left_rad / 2;
        const double middle_sine = sine_ * std::cos(half_rad) + heading_ * std::sin(half_rad);
        fall = 2 * middle_sine * std::sin(half_rad);
    }
    span_end_ = span_begin_ + direction_ * amplitude_ * fall;
}

bool MotorWalk::next_span() {
    if (!turns_ || begin_rad_ + to_turn_rad_ >= sweep_rad_) return false;
    begin_rad_ += to_turn_rad_;
    to_turn_rad_ = pi;
    direction_ = -direction_;
    sine_ = 0;
    heading_ = 1;
    span_begin_ = span_end_;
    measure_span();
    return true;
}

double MotorWalk::next_mm() {
    for (;;) {
        const double middle = static_cast<double>(count_) + direction_ / 2.0;
        if ((span_end_ - middle) * direction_ > touch_steps) {
            count_ += direction_;
            return std::clamp(distance_mm(middle), 0.0, length_mm_);
        }
        if (!next_span()) return no_step_mm;
    }
}

double MotorWalk::distance_mm(double position) const {
    if (!turns_) return (position - span_begin_) * mm_per_step_;
    const double fall = (position - span_begin_) * direction_ / amplitude_;
    // A middle that the span before left open; the formula below is 0 / 0 for it.
    if (!(fall > 0)) return begin_rad_ * mm_per_rad_;
    const double end_sine = std::sqrt(std::max(0.0, sine_ * sine_ + fall * (2 * heading_ - fall)));
    return mm_per_rad_ * (begin_rad_ + 2 * std::atan(fall / (sine_ + end_sine)));
}

}  // namespace lyr::motion
