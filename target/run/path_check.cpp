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

using std::numbers::pi;
// Of angles in double precision, in turns.
constexpr double rounding_turns = 1e-12;
// Of shares of a curve that were computed from different ones: far below a step on the longest curve.
constexpr double same_share = 1e-11;

// A place where a step may be due. It is decided if the curve passes the middle there for certain.
struct Place {
    double share;
    bool decided;
};

// Looks along one curve for the places where an axis may step through a middle in one direction.
struct Crossing {
    const PathCurve& curve;
    std::size_t axis;
    double middle_mm, slack_mm;
    double sign;  // +1: upwards

    double ahead(double at_mm) const { return sign * (at_mm - middle_mm); }
    bool touches(double at_mm) const { return std::abs(at_mm - middle_mm) <= slack_mm; }

    // The first place from the share on; `at_mm` is where the axis is there. `again`: after a place found there.
    std::optional<Place> find(double share, double at_mm, bool again) const {
        // Other axes, due a moment later by rounding, have led the curve on past the middle.
        if (ahead(at_mm) > slack_mm && !again) return Place{share, true};
        const bool turns = curve.is_arc && axis <= axis_y;
        return turns ? on_arc(share, at_mm, again) : on_line(share, at_mm, again);
    }

private:
    std::optional<Place> on_line(double share, double at_mm, bool again) const {
        const double change = curve.to_mm[axis] - curve.from_mm[axis];
        const bool passes = sign * change > 0 && ahead(curve.to_mm[axis]) > slack_mm;
        if (again) return std::nullopt;
        if (touches(at_mm) && !passes) return Place{share, false};
        if (sign * change <= 0 || ahead(curve.to_mm[axis]) < -slack_mm) return std::nullopt;
        return Place{std::clamp((middle_mm - curve.from_mm[axis]) / change, share, 1.0), passes};
    }

    std::optional<Place> on_arc(double share, double at_mm, bool again) const {
        const double center = axis == axis_x ? curve.center_x_mm : curve.center_y_mm;
        const double exact_reach = sign * (middle_mm - center) / curve.radius_mm;
        const double beyond_mm = (1 - exact_reach) * curve.radius_mm;  // that the extreme gets
        if (beyond_mm < -slack_mm) return std::nullopt;
        // Turned so that "far enough" is cos(turned) >= reach, and time runs towards larger angles.
        const double angle = curve.start_angle_rad + curve.sweep_rad * share -
                             (axis == axis_y ? pi / 2 : 0) + (sign < 0 ? pi : 0);
        const double turned = curve.sweep_rad < 0 ? -angle : angle;
        const double half_width = std::acos(std::clamp(exact_reach, -1.0, 1.0));
        const double turns = (turned + half_width) / (2 * pi);
        const double sweep = std::abs(curve.sweep_rad);
        const auto entry = [&](double turn) {
            return share + (2 * pi * turn - half_width - turned) / sweep;
        };
        // Passed if the extreme lies further than a touch, and the curve gets there or as far.
        const auto passes = [&](double at) {
            const bool to_extreme = at + half_width / sweep <= 1;
            return beyond_mm > slack_mm && (to_extreme || ahead(curve.to_mm[axis]) > slack_mm);
        };
        const bool touching = touches(at_mm), rising = std::sin(turned) < 0;
        if (touching && !again) {
            // On the way past the middle the entry nearby is the place, though another axis, due a moment later by
            // rounding, may have led the curve on to just behind it.
            const double at = std::clamp(entry(std::round(turns)), share, 1.0);
            if (rising && passes(at)) return Place{at, true};
            return Place{share, false};
        }
        double turn =
            touching && rising ? std::round(turns) + 1 : std::ceil(turns - rounding_turns);
        if (again && entry(turn) < share + same_share) ++turn;
        const double at = std::max(share, entry(turn));
        if (at > 1) return std::nullopt;
        return Place{at, passes(at)};
    }
};

}  // namespace

// The step that is to be placed.
struct PathCheck::Due {
    const StepPositions& before;
    std::size_t axis;
    double middle_mm, slack_mm, sign;
};

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
    PathCurve& start = curves_.emplace_back();
    start.from_mm = start.to_mm = origin_mm;
    readings_.resize(1);
    readings_.front().point_mm = origin_mm;
    for (std::size_t i = 0; i < axis_count; ++i) step_mm_[i] = 1 / steps_per_mm[i];
}

void PathCheck::step(const DecodedStep& step) {
    if (lost()) return;
    const double sign = step.positive ? 1 : -1;
    const auto before = static_cast<double>(step.before[step.axis]);
    const Due due{step.before, step.axis, position_mm(step.axis, before + sign / 2),
                  touch_steps / steps_per_mm_[step.axis], sign};
    const std::size_t count = readings_.size();
    for (std::size_t i = 0; i < count; ++i) place(i, due);
    sift();
}

void PathCheck::place(std::size_t index, const Due& due) {
    const Sought first = seek(readings_[index], due, false);
    if (first != Sought::touched) return step_here(readings_[index], due);
    Reading rest = readings_[index];
    step_here(readings_[index], due);
    const double most_steps = readings_[index].deviation.worst_steps + left_behind_steps;
    for (Sought next = first; next == Sought::touched && readings_.size() < most_readings;) {
        next = seek(rest, due, true);
        if (next == Sought::nowhere || rest.deviation.worst_steps > most_steps) return;
        step_here(readings_.emplace_back(rest), due);
    }
}

PathCheck::Sought PathCheck::seek(Reading& reading, const Due& due, bool again) {
    for (;;) {
        const Crossing crossing{curve_of(reading), due.axis, due.middle_mm, due.slack_mm, due.sign};
        const auto place = crossing.find(reading.share, reading.point_mm[due.axis], again);
        follow_to(reading, place ? place->share : 1.0, due.before);
        if (place) return place->decided ? Sought::passed : Sought::touched;
        if (reading.deviation.worst_steps > lost_steps || !next_curve(reading))
            return Sought::nowhere;
        again = false;
    }
}

// The point where the step was due belongs to the new position too.
void PathCheck::step_here(Reading& reading, const Due& due) const {
    const std::int64_t after = due.before[due.axis] + (due.sign > 0 ? 1 : -1);
    measure(reading, due.axis, reading.point_mm, after);
}

void PathCheck::sift() {
    const auto is_better = [](const Reading& a, const Reading& b) {
        return a.deviation.worst_steps < b.deviation.worst_steps;
    };
    if (readings_.size() > 1) {
        std::stable_sort(readings_.begin(), readings_.end(), is_better);
        const double most_steps = deviation().worst_steps + left_behind_steps;
        std::size_t kept = 0;
        for (const Reading& reading : readings_) {
            const auto is_same = [&](const Reading& better) {
                return better.curve == reading.curve &&
                       std::abs(better.share - reading.share) <= same_share;
            };
            const auto better = readings_.begin() + static_cast<std::ptrdiff_t>(kept);
            if (reading.deviation.worst_steps > most_steps) break;
            if (std::any_of(readings_.begin(), better, is_same)) continue;
            readings_[kept++] = reading;
        }
        readings_.resize(kept);
    }
    std::size_t first = readings_.front().curve;
    for (const Reading& reading : readings_) first = std::min(first, reading.curve);
    for (; dropped_ < first; ++dropped_) curves_.pop_front();
}

void PathCheck::finish(const StepPositions& positions) {
    if (lost()) return;
    for (Reading& reading : readings_) {
        do follow_to(reading, 1.0, positions);
        while (reading.deviation.worst_steps <= lost_steps && next_curve(reading));
    }
    sift();
}

bool PathCheck::next_curve(Reading& reading) {
    if (reading.curve + 1 == dropped_ + curves_.size()) {
        if (ended_) return false;
        PathCurve next;
        const Result<bool> more = source_(next);
        if (!more) status_ = more.error();
        ended_ = !more || !*more;
        if (ended_) return false;
        curves_.push_back(next);
    }
    ++reading.curve;
    reading.share = 0;
    reading.point_mm = curve_of(reading).from_mm;
    return true;
}

void PathCheck::follow_to(Reading& reading, double share, const StepPositions& positions) const {
    // Nothing has changed since the last measurement here but what step_here() has measured.
    if (share == reading.share && share > 0) return;
    const PathCurve& curve = curve_of(reading);
    if (curve.is_arc) {
        // Multiples of a quarter turn strictly inside are the turning points of x and y.
        const double from = (curve.start_angle_rad + curve.sweep_rad * reading.share) / (pi / 2);
        const double to = (curve.start_angle_rad + curve.sweep_rad * share) / (pi / 2);
        const double low = std::min(from, to), high = std::max(from, to);
        for (double quarter = std::floor(low) + 1; quarter < high; ++quarter) {
            const double angle = quarter * (pi / 2);
            measure(reading, curve.at((angle - curve.start_angle_rad) / curve.sweep_rad),
                    positions);
        }
    }
    reading.share = share;
    reading.point_mm = curve.at(share);
    measure(reading, reading.point_mm, positions);
}

void PathCheck::measure(Reading& reading, const AxisValues& at_mm,
                        const StepPositions& positions) const {
    double squared_mm2 = 0;
    for (std::size_t i = 0; i < axis_count; ++i) {
        const double off_mm = measure(reading, i, at_mm, positions[i]);
        if (i != axis_e) squared_mm2 += off_mm * off_mm;
    }
    if (squared_mm2 <= reading.distance_mm2) return;
    reading.distance_mm2 = squared_mm2;
    reading.deviation.distance_mm = std::sqrt(squared_mm2);
}

double PathCheck::measure(Reading& reading, std::size_t axis, const AxisValues& at_mm,
                          std::int64_t position) const {
    const double off_mm =
        shown(std::abs(at_mm[axis] - position_mm(axis, static_cast<double>(position))));
    const double off_steps = off_mm * steps_per_mm_[axis];
    Deviation& deviation = reading.deviation;
    if (off_steps <= deviation.steps[axis]) return off_mm;
    deviation.steps[axis] = off_steps;
    if (off_steps <= deviation.worst_steps) return off_mm;
    deviation.worst_steps = off_steps;
    deviation.worst_axis = axis;
    deviation.worst_layer = curve_of(reading).layer;
    deviation.worst_at_mm = at_mm;
    return off_mm;
}

}  // namespace lyr::run
