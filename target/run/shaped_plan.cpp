#include "target/run/shaped_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lyr::run {
namespace {

// As terms of a sum; of no taps, the axis as planned.
std::vector<PlanCopy> copies_of(const motion::Taps& taps, std::size_t axis) {
    std::vector<PlanCopy> copies;
    if (taps.empty()) copies.push_back({axis, 1, 0});
    for (const motion::Tap& tap : taps)
        for (std::size_t channel = 0; channel < motion::channel_count; ++channel)
            if (tap.weights[channel] != 0)
                copies.push_back({channel, tap.weights[channel], tap.offset_ns});
    return copies;
}

}  // namespace

ShapedPlan::ShapedPlan(const config::Printer& printer) : machine_(moves::kinematics_of(printer)) {
    const motion::Shaping shaping = moves::shaping_of(printer);
    bed_ = shaping.bed;
    const motion::Point origin{printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]};
    mixes_all_ = bed_ || std::holds_alternative<motion::Delta>(machine_);
    shares_ = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    if (std::holds_alternative<motion::CoreXy>(machine_)) {
        shares_[motion::axis_x] = {1, 1, 0, 0};
        shares_[motion::axis_y] = {1, -1, 0, 0};
    }
    std::int64_t ahead_ns = 0, behind_ns = 0;
    for (std::size_t i = 0; i < motion::axis_count; ++i) {
        steps_per_mm_[i] = printer.axes[i].steps_per_mm;
        std::vector<PlanCopy> copies =
            copies_of(i == motion::axis_e ? shaping.extruder : shaping.axes[i], i);
        for (const PlanCopy& copy : copies) {
            ahead_ns = std::max(ahead_ns, copy.offset_ns());
            behind_ns = std::max(behind_ns, -copy.offset_ns());
        }
        axes_.emplace_back(std::move(copies));
    }
    for (std::size_t motor = 0; motor < motion::extruder_motor; ++motor)
        origin_mm_[motor] = carried_mm(motor, origin);
    lead_ns_ = ahead_ns;
    reach_ns_ = ahead_ns + behind_ns;
}

void ShapedPlan::append(const motion::PlannedMove& move) {
    const double advance_mm = motion::advance_of(move.path);
    const bool presses = advance_mm > 0 && motion::tangent_at(move.path, 0) != motion::Point{};
    pieces_.push_back({move, fed_mm_, pressed_mm_, presses});
    const double due_mm = advance_mm - fed_error_mm_, fed_mm = fed_mm_ + due_mm;
    fed_error_mm_ = (fed_mm - fed_mm_) - due_mm;
    fed_mm_ = fed_mm;
    if (presses) pressed_mm_ += advance_mm;
}

void ShapedPlan::forget_before(std::int64_t time_ns) {
    while (pieces_.size() > 1 && pieces_[1].move.start_ns < time_ns - reach_ns_)
        pieces_.pop_front();
    kept_until_ns_ = pieces_.size() > 1 ? pieces_[1].move.start_ns + reach_ns_ : time_ns;
}

double ShapedPlan::carried_mm(std::size_t motor, const motion::Point& at) const {
    const double z_mm = at.z + (bed_ ? bed_->lift_mm(at) : 0);
    if (const auto* delta = std::get_if<motion::Delta>(&machine_)) {
        const motion::Delta::Tower& tower = delta->towers[motor];
        const double dx = at.x - tower.x_mm, dy = at.y - tower.y_mm;
        return z_mm + std::sqrt(tower.arm_mm * tower.arm_mm - dx * dx - dy * dy);
    }
    if (motor == motion::axis_z) return z_mm;
    if (!std::holds_alternative<motion::CoreXy>(machine_))
        return motor == motion::axis_x ? at.x : at.y;
    return motor == motion::axis_x ? at.x + at.y : at.x - at.y;
}

double ShapedPlan::sought_steps(std::size_t motor, std::int64_t plan_ns) {
    if (mixes_all_ && motor != motion::extruder_motor) return mixed_steps(motor, plan_ns);
    MotorSeries& series = series_[motor];
    series = {plan_ns, std::numeric_limits<std::int64_t>::max(), {-origin_mm_[motor]}};
    for (std::size_t axis = 0; axis < axes_.size(); ++axis)
        if (const double share = shares_[motor][axis]; share != 0)
            series.end_ns =
                std::min(series.end_ns, axes_[axis].add_to(series.steps, share, pieces_, plan_ns));
    for (double& power : series.steps) power *= steps_per_mm_[motor];
    return series.steps[0];
}

double ShapedPlan::mixed_steps(std::size_t motor, std::int64_t plan_ns) {
    const motion::Point at{shaped_mm(motion::axis_x, plan_ns), shaped_mm(motion::axis_y, plan_ns),
                           shaped_mm(motion::axis_z, plan_ns)};
    return steps_per_mm_[motor] * (carried_mm(motor, at) - origin_mm_[motor]);
}

}  // namespace lyr::run
