#include "target/run/shaped_plan.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace lyr::run {
namespace {

// How far before and after the time of the plan the taps look.
struct Reach {
    std::int64_t ahead_ns = 0, behind_ns = 0;

    void include(const motion::Taps& taps) {
        for (const motion::Tap& tap : taps) {
            ahead_ns = std::max(ahead_ns, tap.offset_ns);
            behind_ns = std::max(behind_ns, -tap.offset_ns);
        }
    }
};

}  // namespace

ShapedPlan::ShapedPlan(const config::Printer& printer)
    : machine_(moves::kinematics_of(printer)), shaping_(moves::shaping_of(printer)) {
    for (std::size_t i = 0; i < steps_per_mm_.size(); ++i)
        steps_per_mm_[i] = printer.axes[i].steps_per_mm;
    origin_mm_ = carried_mm({printer.start_mm[0], printer.start_mm[1], printer.start_mm[2]});
    const bool is_corexy = std::holds_alternative<motion::CoreXy>(machine_);
    const bool mixes_all = shaping_.bed || std::holds_alternative<motion::Delta>(machine_);
    for (std::size_t motor = 0; motor < depends_.size(); ++motor)
        for (std::size_t axis = 0; axis < depends_.size(); ++axis)
            depends_[motor][axis] =
                mixes_all || motor == axis ||
                (is_corexy && motor != motion::axis_z && axis != motion::axis_z);
    Reach reach;
    for (const motion::Taps& taps : shaping_.axes) reach.include(taps);
    reach.include(shaping_.extruder);
    lead_ns_ = reach.ahead_ns;
    reach_ns_ = reach.ahead_ns + reach.behind_ns;
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
}

// The last that has begun, or the first.
const ShapedPlan::Piece& ShapedPlan::piece_at(std::int64_t plan_ns) const {
    const auto after = std::upper_bound(
        pieces_.begin(), pieces_.end(), plan_ns,
        [](std::int64_t time_ns, const Piece& piece) { return time_ns < piece.move.start_ns; });
    return after == pieces_.begin() ? *after : *std::prev(after);
}

double ShapedPlan::channel_mm(std::size_t channel, std::int64_t plan_ns) const {
    const Piece& piece = piece_at(plan_ns);
    const motion::PlannedMove& move = piece.move;
    const double since_s =
        (static_cast<double>(plan_ns - move.start_ns) - move.start_part_ns) / ns_per_s;
    const double distance_mm =
        move.profile.distance_at(std::clamp(since_s, 0.0, move.profile.duration_s));
    const double share = distance_mm / move.profile.length_mm;
    if (channel == motion::axis_e) return piece.fed_mm + motion::advance_of(move.path) * share;
    if (channel == motion::pressed_channel)
        return piece.pressed_mm + (piece.presses ? motion::advance_of(move.path) * share : 0);
    const motion::Point at = motion::point_at_share(move.path, share);
    return channel == motion::axis_x ? at.x : channel == motion::axis_y ? at.y : at.z;
}

double ShapedPlan::shaped_mm(std::size_t axis, std::int64_t plan_ns) const {
    const motion::Taps& taps = axis == motion::axis_e ? shaping_.extruder : shaping_.axes[axis];
    if (taps.empty()) return channel_mm(axis, plan_ns);
    double sum_mm = 0;
    for (const motion::Tap& tap : taps)
        for (std::size_t channel = 0; channel < motion::channel_count; ++channel)
            if (tap.weights[channel] != 0)
                sum_mm += tap.weights[channel] * channel_mm(channel, plan_ns + tap.offset_ns);
    return sum_mm;
}

std::array<double, 3> ShapedPlan::carried_mm(motion::Point at) const {
    if (shaping_.bed) at.z += shaping_.bed->lift_mm(at);
    if (std::holds_alternative<motion::CoreXy>(machine_)) return {at.x + at.y, at.x - at.y, at.z};
    std::array<double, 3> carried{at.x, at.y, at.z};
    if (const auto* delta = std::get_if<motion::Delta>(&machine_))
        for (std::size_t i = 0; i < carried.size(); ++i) {
            const motion::Delta::Tower& tower = delta->towers[i];
            const double dx = at.x - tower.x_mm, dy = at.y - tower.y_mm;
            carried[i] = at.z + std::sqrt(tower.arm_mm * tower.arm_mm - dx * dx - dy * dy);
        }
    return carried;
}

double ShapedPlan::motor_steps(std::size_t motor, std::int64_t time_ns) const {
    const std::int64_t plan_ns = time_ns - lead_ns_;
    if (motor == motion::extruder_motor)
        return steps_per_mm_[motor] * shaped_mm(motion::axis_e, plan_ns);
    const auto along = [&](std::size_t axis) {
        return depends_[motor][axis] ? shaped_mm(axis, plan_ns) : 0;
    };
    const motion::Point at{along(motion::axis_x), along(motion::axis_y), along(motion::axis_z)};
    return steps_per_mm_[motor] * (carried_mm(at)[motor] - origin_mm_[motor]);
}

}  // namespace lyr::run
