// Directions are folded into the first quadrant: the limits of an axis know no sign, so only |cos|
// and |sin| of the direction of an arc's radius count, and an arc sweeps one interval of that
// angle.

#include "target/motion/limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace lyr::motion {
namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

// On an arc this share of the weaker axis's acceleration is kept for changing speed; 0.8 is then
// left for the turning (both are perpendicular), which costs a tenth of the highest speed on a
// circle. It is the same for every piece of a circle, so that cutting one up does not make it
// slower.
constexpr double tangential_share = 0.6;

double ratio(double limit, double share) {
    return share > 0 ? limit / share : infinity;
}

double requested_mm_s2(const Move& move) {
    return move.acceleration_mm_s2 > 0 ? move.acceleration_mm_s2 : infinity;
}

struct Direction {
    double cosine, sine;

    Direction mirrored() const { return {sine, cosine}; }
};

Direction direction_at(double angle_rad) {
    return {std::cos(angle_rad), std::sin(angle_rad)};
}

// Angles of the radius, folded; both within 0..pi/2.
struct Folded {
    Direction low, high;

    Folded mirrored() const { return {high.mirrored(), low.mirrored()}; }
};

Folded folded_sweep(const Arc& arc) {
    const double from = arc.start_angle_rad / (pi / 2);
    const double to = from + arc.sweep_rad / (pi / 2);
    const double low = std::min(from, to), high = std::max(from, to);
    const auto fold = [](double quarters) {
        const double in_half_turn = quarters - 2 * std::floor(quarters / 2);
        return std::min(in_half_turn, 2 - in_half_turn) * (pi / 2);
    };
    Folded folded{direction_at(std::min(fold(low), fold(high))),
                  direction_at(std::max(fold(low), fold(high)))};
    // An axis is passed: even quarters are those of x, odd ones of y.
    const auto passes = [=](double first) {
        return first + 2 * std::ceil((low - first) / 2) <= high;
    };
    if (passes(0)) folded.low = {1, 0};
    if (passes(1)) folded.high = {0, 1};
    return folded;
}

// The largest A with A sin(p) + C cos(p) <= limit for all p of the range: what is left in the
// direction of motion when C is needed along the radius. The tightest p has cos(p) = C / limit.
double left_over(double needed, double limit, const Folded& range) {
    const double cosine = limit > 0 ? needed / limit : 1;
    Direction tightest{cosine, std::sqrt(std::max(0.0, 1 - cosine * cosine))};
    if (cosine >= range.low.cosine) tightest = range.low;
    if (cosine <= range.high.cosine) tightest = range.high;
    return ratio(std::max(0.0, limit - needed * tightest.cosine), tightest.sine);
}

// Of the two axes in whose plane an arc lies.
struct Plane {
    AxisLimits x, y;
    Folded radius;  // seen from x

    double speed_mm_s() const {
        return std::min(ratio(x.speed_mm_s, radius.high.sine),
                        ratio(y.speed_mm_s, radius.low.cosine));
    }
    double weaker_mm_s2() const { return std::min(x.acceleration_mm_s2, y.acceleration_mm_s2); }
    double tangential_mm_s2(double centripetal) const {
        return std::min(left_over(centripetal, x.acceleration_mm_s2, radius),
                        left_over(centripetal, y.acceleration_mm_s2, radius.mirrored()));
    }
    double centripetal_mm_s2(double tangential) const {
        return std::min(left_over(tangential, x.acceleration_mm_s2, radius.mirrored()),
                        left_over(tangential, y.acceleration_mm_s2, radius));
    }
};

// `shares` of the axes in the motion.
MoveLimits tightest(MoveLimits own, const std::array<double, axis_count>& shares,
                    const Limits& limits) {
    for (std::size_t i = 0; i < axis_count; ++i) {
        own.speed_mm_s = std::min(own.speed_mm_s, ratio(limits.axes[i].speed_mm_s, shares[i]));
        own.acceleration_mm_s2 =
            std::min(own.acceleration_mm_s2, ratio(limits.axes[i].acceleration_mm_s2, shares[i]));
    }
    return own;
}

struct BedWay {
    double level, rise;  // shares of x and y together and of z in the motion
    double turn_per_mm;
    double from_z_mm, to_z_mm;
};

// The lift begins to fade at z = 0 and has faded where 1 / fade_per_mm is.
bool meets_fade(const BedWay& way, const BedShape& bed) {
    const auto [low_mm, high_mm] = std::minmax(way.from_z_mm, way.to_z_mm);
    const auto meets = [&](double z_mm) { return low_mm <= z_mm && z_mm <= high_mm; };
    return bed.fade_per_mm > 0 && (meets(0) || meets(1 / bed.fade_per_mm));
}

MoveLimits over_bed(MoveLimits own, const BedWay& way, const Limits& limits) {
    const BedShape& bed = limits.bed;
    if (!(bed.slope > 0) && !(bed.fade_slope > 0)) return own;
    const auto& [level, rise, turn_per_mm, from_z_mm, to_z_mm] = way;
    const AxisLimits& z = limits.axes[axis_z];
    const double share = rise * (1 + bed.fade_slope) + bed.slope * level;
    const double turning = level * level * (bed.twist_per_mm + bed.slope * turn_per_mm) +
                           2 * bed.slope * level * rise * bed.fade_per_mm;
    const double each_mm_s2 = turning > 0 ? z.acceleration_mm_s2 / 2 : z.acceleration_mm_s2;
    const double jump = bed.kink * level + (meets_fade(way, bed) ? bed.fade_slope * rise : 0);
    own.speed_mm_s =
        std::min({own.speed_mm_s, ratio(z.speed_mm_s, share), std::sqrt(ratio(each_mm_s2, turning)),
                  ratio(limits.bed_jump_mm_s, jump)});
    own.acceleration_mm_s2 = std::min(own.acceleration_mm_s2, ratio(each_mm_s2, share));
    return own;
}

MoveLimits along(const Line& line, const Move& move, double length_mm, const Limits& limits) {
    const std::array<double, axis_count> shares{std::abs(line.to.x - line.from.x) / length_mm,
                                                std::abs(line.to.y - line.from.y) / length_mm,
                                                std::abs(line.to.z - line.from.z) / length_mm,
                                                std::abs(line.advance_mm) / length_mm};
    return over_bed(
        tightest({move.speed_mm_s, requested_mm_s2(move)}, shares, limits),
        {std::hypot(shares[axis_x], shares[axis_y]), shares[axis_z], 0, line.from.z, line.to.z},
        limits);
}

MoveLimits along(const Arc& arc, const Move& move, double length_mm, const Limits& limits) {
    const std::array<double, axis_count> shares{0, 0, std::abs(arc.to.z - arc.from.z) / length_mm,
                                                std::abs(arc.advance_mm) / length_mm};
    MoveLimits own = tightest({move.speed_mm_s, requested_mm_s2(move)}, shares, limits);

    const Plane plane{limits.axes[axis_x], limits.axes[axis_y], folded_sweep(arc)};
    const double level = arc.radius_mm * std::abs(arc.sweep_rad) / length_mm;
    own = over_bed(own, {level, shares[axis_z], 1 / arc.radius_mm, arc.from.z, arc.to.z}, limits);
    const double most = std::min(plane.tangential_mm_s2(0), level * own.acceleration_mm_s2);
    const double kept = std::min(most, tangential_share * plane.weaker_mm_s2());
    const double centripetal = std::min(plane.centripetal_mm_s2(kept), requested_mm_s2(move));
    own.speed_mm_s = std::min({own.speed_mm_s, plane.speed_mm_s() / level,
                               std::sqrt(centripetal * arc.radius_mm) / level});

    const double level_mm_s = level * own.speed_mm_s;
    const double used = level_mm_s * level_mm_s / arc.radius_mm;
    // At least what was kept; rounding could make it less than that, and 0 is no acceleration.
    const double left = std::max(plane.tangential_mm_s2(used), kept);
    own.acceleration_mm_s2 = std::min(most, left) / level;
    return own;
}

bool is_extruder_alone(const Point& tangent) {
    return tangent == Point{};
}

// What the axes can do in a direction.
double acceleration_along(const Point& direction, const Limits& limits) {
    return std::min({ratio(limits.axes[axis_x].acceleration_mm_s2, std::abs(direction.x)),
                     ratio(limits.axes[axis_y].acceleration_mm_s2, std::abs(direction.y)),
                     ratio(limits.axes[axis_z].acceleration_mm_s2, std::abs(direction.z))});
}

double turning_speed_mm_s(const Point& u, const Point& v, const Move& before, const Move& after,
                          const Limits& limits) {
    const Point change{v.x - u.x, v.y - u.y, v.z - u.z};
    const double sine = std::hypot(change.x, change.y, change.z) / 2;  // of half the turn
    if (sine == 0) return infinity;
    const double cosine = std::hypot(u.x + v.x, u.y + v.y, u.z + v.z) / 2;
    const Point bisector{change.x / (2 * sine), change.y / (2 * sine), change.z / (2 * sine)};
    const double acceleration_mm_s2 = std::min(
        {acceleration_along(bisector, limits), requested_mm_s2(before), requested_mm_s2(after)});
    // deviation * cosine / (1 - cosine), without the difference.
    const double deviating_mm =
        limits.junction_deviation_mm * cosine * (1 + cosine) / (sine * sine);
    const double reach_mm = std::min(length_of(before.path), length_of(after.path)) / 2;
    const double radius_mm = std::min(deviating_mm, reach_mm * cosine / sine);
    return std::sqrt(acceleration_mm_s2 * radius_mm);
}

Diagnostic unfit(const std::string& what, const char* expected) {
    return machine_error(what + " must be " + expected);
}

// No machine comes near, and squares of it are still far from overflow.
constexpr double beyond_any = 1e9;

bool is_positive(double value) {
    return value > 0 && value <= beyond_any;
}

}  // namespace

Status check(const Limits& limits) {
    constexpr std::array names{"x", "y", "z", "e"};
    for (std::size_t i = 0; i < axis_count; ++i) {
        const std::string axis = std::string(" of axis ") + names[i];
        if (!is_positive(limits.axes[i].speed_mm_s))
            return unfit("the speed limit" + axis, "a positive number of mm/s");
        if (!is_positive(limits.axes[i].acceleration_mm_s2))
            return unfit("the acceleration limit" + axis, "a positive number of mm/s^2");
    }
    if (limits.junction_deviation_mm != 0 && !is_positive(limits.junction_deviation_mm))
        return unfit("the junction deviation", "0 or a positive number of mm");
    if (limits.jerk_mm_s3 != 0 && !(limits.jerk_mm_s3 >= 1 && limits.jerk_mm_s3 <= 1e12))
        return unfit("the limit of jerk", "0 or from 1 to 1e12 mm/s^3");
    if (!(limits.minimum_cruise_ratio >= 0 && limits.minimum_cruise_ratio < 1))
        return unfit("the minimum cruise ratio", "from 0 to less than 1");
    if (!is_positive(limits.extruder_jump_mm_s))
        return unfit("the extruder's jump in speed", "a positive number of mm/s");
    return Done{};
}

MoveLimits limits_of(const Move& move, const Limits& limits) {
    const double length_mm = length_of(move.path);
    return std::visit([&](const auto& shape) { return along(shape, move, length_mm, limits); },
                      move.path);
}

double corner_speed_mm_s(const Move& before, const Move& after, const Limits& limits) {
    const double before_mm = length_of(before.path), after_mm = length_of(after.path);
    const double rate_before = advance_of(before.path) / before_mm;
    const double rate_after = advance_of(after.path) / after_mm;
    const Point u = tangent_at(before.path, before_mm), v = tangent_at(after.path, 0);
    if (is_extruder_alone(u) || is_extruder_alone(v)) {
        const bool goes_on = is_extruder_alone(u) && is_extruder_alone(v) &&
                             std::signbit(rate_before) == std::signbit(rate_after);
        return goes_on ? infinity : 0;
    }
    const double feeding_mm_s =
        ratio(limits.extruder_jump_mm_s, std::abs(rate_after - rate_before));
    return std::min(feeding_mm_s, turning_speed_mm_s(u, v, before, after, limits));
}

}  // namespace lyr::motion
