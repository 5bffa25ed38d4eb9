// A crossing on an arc is found in closed form: the coordinate is a cosine of the angle.

#include "target/run/path_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lyr::run {
namespace {

using config::axis_count;
using config::axis_e;
using config::axis_x;
using config::axis_y;

constexpr double pi = std::numbers::pi;
// Of angles in double precision, in turns.
constexpr double rounding_turns = 1e-12;

// Looks for the first share from a given one on at which an axis passes a middle in one direction.
struct Crossing {
    const PathCurve& curve;
    std::size_t axis;
    double middle_mm, slack_mm;
    double sign;    // +1: upwards
    bool reversal;  // the axis passed the same middle the other way last

    double ahead(double at_mm) const { return sign * (at_mm - middle_mm); }
    bool close(double at_mm) const { return std::abs(at_mm - middle_mm) <= slack_mm; }

    std::optional<double> on_line(double share) const {
        const double change = curve.to_mm[axis] - curve.from_mm[axis];
        if (sign * change <= 0 || ahead(curve.to_mm[axis]) < -slack_mm) return std::nullopt;
        return std::clamp((middle_mm - curve.from_mm[axis]) / change, share, 1.0);
    }

    std::optional<double> on_arc(double share, double at_mm) const {
        const double center = axis == axis_x ? curve.center_x_mm : curve.center_y_mm;
        double reach = sign * (middle_mm - center) / curve.radius_mm;
        if (reach > 1 && (reach - 1) * curve.radius_mm <= slack_mm) reach = 1;
        if (reach > 1 || reach < -1) return std::nullopt;
        // Turned so that "far enough" is cos(turned) >= reach, and time runs towards larger angles.
        const double angle = curve.start_angle_rad + curve.sweep_rad * share -
                             (axis == axis_y ? pi / 2 : 0) + (sign < 0 ? pi : 0);
        const double turned = curve.sweep_rad < 0 ? -angle : angle;
        const double half_width = std::acos(reach);
        const double turns = (turned + half_width) / (2 * pi);
        // On the way past the middle the entry nearby is the one looked for, though another axis, due a
        // moment later by rounding, may have led the curve on to just behind it.
        const bool passing = close(at_mm) && std::sin(turned) < 0;
        const double whole = passing ? std::round(turns) : std::ceil(turns - rounding_turns);
        const double entry = 2 * pi * whole - half_width;
        const double at = std::max(share, share + (entry - turned) / std::abs(curve.sweep_rad));
        if (at <= 1) return at;
        if (reversal || !close(curve.to_mm[axis])) return std::nullopt;
        return 1.0;
    }

    // `at_mm` is where the axis is at the share.
    std::optional<double> from(double share, double at_mm) const {
        const double now_mm = ahead(at_mm);
        // Other axes, due a moment later by rounding, have led the curve on past the middle.
        if (now_mm > slack_mm) return share;
        const auto found = curve.is_arc && axis <= axis_y ? on_arc(share, at_mm) : on_line(share);
        if (found || reversal || now_mm < -slack_mm) return found;
        return share;
    }
};

}  // namespace

AxisValues PathCurve::at(double share) const {
    AxisValues point;
    for (std::size_t i = 0; i < axis_count; ++i)
        point[i] = from_mm[i] + share * (to_mm[i] - from_mm[i]);
    if (!is_arc) return point;
    const double angle = start_angle_rad + share * sweep_rad;
    point[axis_x] = center_x_mm + radius_mm * std::cos(angle);
    point[axis_y] = center_y_mm + radius_mm * std::sin(angle);
    return point;
}

PathCheck::PathCheck(const AxisValues& steps_per_mm, const AxisValues& origin_mm,
                     CurveSource source)
    : steps_per_mm_(steps_per_mm), origin_mm_(origin_mm), source_(std::move(source)) {
    // Where the head stands before the file's first motion.
    curve_.from_mm = curve_.to_mm = point_mm_ = origin_mm;
    for (std::size_t i = 0; i < axis_count; ++i) step_mm_[i] = 1 / steps_per_mm[i];
}

void PathCheck::step(const DecodedStep& step) {
    if (lost()) return;
    const double sign = step.positive ? 1 : -1;
    const auto before = static_cast<double>(step.before[step.axis]);
    const double middle_mm = position_mm(step.axis, before + sign / 2);
    const bool reversal = last_sign_[step.axis] * sign < 0;
    last_sign_[step.axis] = sign;
    const double slack_mm = touch_steps / steps_per_mm_[step.axis];
    for (;;) {
        const Crossing crossing{curve_, step.axis, middle_mm, slack_mm, sign, reversal};
        const std::optional<double> share = crossing.from(share_, point_mm_[step.axis]);
        follow_to(share.value_or(1.0), step.before);
        if (share || lost()) break;
        if (!next_curve()) break;
    }
    // The point where the step was due belongs to the new position too.
    measure(step.axis, point_mm_, step.before[step.axis] + (step.positive ? 1 : -1));
}

void PathCheck::finish(const StepPositions& positions) {
    if (lost()) return;
    do follow_to(1.0, positions);
    while (!lost() && next_curve());
}

bool PathCheck::next_curve() {
    if (ended_) return false;
    const Result<bool> more = source_(curve_);
    if (!more) status_ = more.error();
    ended_ = !more || !*more;
    if (ended_) return false;
    share_ = 0;
    point_mm_ = curve_.from_mm;
    return true;
}

void PathCheck::follow_to(double share, const StepPositions& positions) {
    // Nothing has changed since the last measurement here but what step() has measured.
    if (share == share_ && share > 0) return;
    if (curve_.is_arc) {
        // Multiples of a quarter turn strictly inside are the turning points of x and y.
        const double from = (curve_.start_angle_rad + curve_.sweep_rad * share_) / (pi / 2);
        const double to = (curve_.start_angle_rad + curve_.sweep_rad * share) / (pi / 2);
        const double low = std::min(from, to), high = std::max(from, to);
        for (double quarter = std::floor(low) + 1; quarter < high; ++quarter) {
            const double angle = quarter * (pi / 2);
            measure(curve_.at((angle - curve_.start_angle_rad) / curve_.sweep_rad), positions);
        }
    }
    share_ = share;
    point_mm_ = curve_.at(share);
    measure(point_mm_, positions);
}

void PathCheck::measure(const AxisValues& at_mm, const StepPositions& positions) {
    double squared_mm2 = 0;
    for (std::size_t i = 0; i < axis_count; ++i) {
        const double off_mm = measure(i, at_mm, positions[i]);
        if (i != axis_e) squared_mm2 += off_mm * off_mm;
    }
    if (squared_mm2 <= distance_mm2_) return;
    distance_mm2_ = squared_mm2;
    deviation_.distance_mm = std::sqrt(squared_mm2);
}

double PathCheck::measure(std::size_t axis, const AxisValues& at_mm, std::int64_t position) {
    const double off_mm = std::abs(at_mm[axis] - position_mm(axis, static_cast<double>(position)));
    const double off_steps = off_mm * steps_per_mm_[axis];
    if (off_steps <= deviation_.steps[axis]) return off_mm;
    deviation_.steps[axis] = off_steps;
    if (off_steps <= deviation_.worst_steps) return off_mm;
    deviation_.worst_steps = off_steps;
    deviation_.worst_axis = axis;
    deviation_.worst_layer = curve_.layer;
    deviation_.worst_at_mm = at_mm;
    return off_mm;
}

}  // namespace lyr::run
