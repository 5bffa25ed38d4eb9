// With k the curvature and the middle as origin, x along the tangent and y to its left, the circle (or line) is
//     k (x^2 + y^2) - 2 y = 0,
// and a point's foot is at the angle atan2(k x, 1 - k y), divided by k the length to it. All of it is exact for k = 0
// and loses nothing for small k.

#include "kernel/region/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lyr::region {
namespace {

using std::numbers::pi;

// Where the curve runs parallel to an axis, strictly between its ends, from the start on.
struct Turns {
    std::array<double, 3> along_mm{};
    std::size_t count = 0;
};

// tan x < 1.56 x for x in (0, 1).
constexpr double quick_turn_rad = 1, tangent_bound = 1.56;

// Whether the curve surely turns by less than the angle that its middle's tangent has to the axis.
bool turns_little(const Curve& curve, int axis) {
    const double half_turn = std::abs(curve.curvature_per_mm) * curve.half_mm;
    return half_turn < quick_turn_rad && tangent_bound * half_turn * std::abs(curve.tangent[axis]) <
                                             std::abs(curve.tangent[1 - axis]);
}

Turns turns_of(const Curve& curve, int axis) {
    Turns turns;
    const double k = curve.curvature_per_mm;
    if (k == 0 || turns_little(curve, axis)) return turns;
    const double ahead = axis * pi / 2 - std::atan2(curve.tangent.y(), curve.tangent.x());
    const double half = std::abs(k) * curve.half_mm;
    // ahead + n pi in (-half, half)
    const double first = std::ceil((-half - ahead) / pi), last = std::floor((half - ahead) / pi);
    for (double n = first; n <= last && turns.count < turns.along_mm.size(); ++n) {
        const double along = (ahead + n * pi) / k;
        if (std::abs(along) < curve.half_mm) turns.along_mm[turns.count++] = along;
    }
    if (k < 0) std::reverse(turns.along_mm.begin(), turns.along_mm.begin() + turns.count);
    return turns;
}

Curve part_of(const Curve& whole, double from, double to, const Point2& start, const Point2& end) {
    const double middle = (from + to) / 2;
    return {start,
            end,
            point_on(whole, middle),
            tangent_at(whole, middle),
            whole.curvature_per_mm,
            (to - from) / 2};
}

void circle_halves(const FullCircle& circle,
                   const std::function<void(const Curve&, std::size_t)>& take) {
    const double r = circle.radius_mm, turn = circle.counter_clockwise ? 1 : -1;
    const Point2 bottom = circle.centre - Vector2(0, r), top = circle.centre + Vector2(0, r);
    const auto half = [&](double side) {
        const bool rises = turn * side > 0;
        return Curve{rises ? bottom : top,
                     rises ? top : bottom,
                     circle.centre + Vector2(side * r, 0),
                     {0, rises ? 1.0 : -1.0},
                     turn / r,
                     pi * r / 2};
    };
    // From the bottom, up one side and down the other.
    take(half(turn), 0);
    take(half(-turn), 0);
}

// In the form k q^2 + 2 m q + c = 0, with |m|^2 - k c = 1.
struct Implicit {
    double k;
    Vector2 m;
    double c;
};

Implicit seen_from(const Point2& origin, const Curve& curve) {
    const Vector2 to = curve.middle - origin, left = left_of(curve.tangent);
    const double k = curve.curvature_per_mm;
    return {k, -left - k * to, k * to.squaredNorm() + 2 * left.dot(to)};
}

}  // namespace

Curve curve_of(const Point2& start, const Segment& segment) {
    const Vector2 chord = segment.end - start;
    const double c = chord.norm(), s = segment.sagitta_mm;
    const Vector2 tangent = chord / c;
    return {start,
            segment.end,
            0.5 * (start + segment.end) - s * left_of(tangent),
            tangent,
            8 * s / (c * c + 4 * s * s),
            length_mm(start, segment) / 2};
}

void for_monotone_curves(const Contour& contour,
                         const std::function<void(const Curve&, std::size_t)>& take) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) return circle_halves(*circle, take);
    const Path& path = std::get<Path>(contour);
    Point2 from = path.start;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        const Segment& segment = path.segments[i];
        if (segment.end == from) continue;
        const Curve whole = curve_of(from, segment);
        const Turns turns = turns_of(whole, 0);
        double at = -whole.half_mm;
        for (std::size_t t = 0; t < turns.count; ++t) {
            const Point2 extreme = point_on(whole, turns.along_mm[t]);
            take(part_of(whole, at, turns.along_mm[t], from, extreme), i);
            at = turns.along_mm[t];
            from = extreme;
        }
        take(turns.count == 0 ? whole : part_of(whole, at, whole.half_mm, from, segment.end), i);
        from = segment.end;
    }
}

double along_mm(const Curve& curve, const Point2& point) {
    const Vector2 offset = point - curve.middle;
    const double x = offset.dot(curve.tangent), y = cross(curve.tangent, offset);
    const double k = curve.curvature_per_mm;
    return k == 0 ? x : std::atan2(k * x, 1 - k * y) / k;
}

double across_mm(const Curve& curve, const Point2& point) {
    // As offset_mm() of kernel/contour, from the middle.
    const Vector2 offset = point - curve.middle;
    const double k = curve.curvature_per_mm;
    const double excess = 2 * cross(offset, curve.tangent) + k * offset.squaredNorm();
    return excess / (1 + std::sqrt(std::max(0.0, 1 + k * excess)));
}

Point2 point_on(const Curve& curve, double along) {
    const double k = curve.curvature_per_mm;
    if (k == 0) return curve.middle + along * curve.tangent;
    const double half_sine = std::sin(k * along / 2);
    return curve.middle + std::sin(k * along) / k * curve.tangent +
           2 * half_sine * half_sine / k * left_of(curve.tangent);
}

Vector2 tangent_at(const Curve& curve, double along) {
    const double turn = curve.curvature_per_mm * along, c = std::cos(turn), s = std::sin(turn);
    return c * curve.tangent + s * left_of(curve.tangent);
}

Vector2 tangent_beside(const Curve& curve, const Point2& point) {
    const Vector2 offset = point - curve.middle;
    const double k = curve.curvature_per_mm;
    const Vector2 direction = (1 - k * cross(curve.tangent, offset)) * curve.tangent +
                              k * offset.dot(curve.tangent) * left_of(curve.tangent);
    return direction.normalized();
}

bool passes(const Curve& curve, const Point2& point, double within_mm) {
    // What is that far from the whole circle is so from the ends too.
    if (std::abs(across_mm(curve, point)) > within_mm) return false;
    if (std::abs(along_mm(curve, point)) <= curve.half_mm) return true;
    return (point - curve.start).norm() <= within_mm || (point - curve.end).norm() <= within_mm;
}

Box2 box_of(const Curve& curve) {
    Box2 box(curve.start);
    box.extend(curve.end);
    for (const int axis : {0, 1}) {
        const Turns turns = turns_of(curve, axis);
        for (std::size_t t = 0; t < turns.count; ++t) {
            box.extend(point_on(curve, turns.along_mm[t]));
        }
    }
    return box;
}

Box2 box_of(const Contour& contour) {
    Box2 box;
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        const Vector2 radius(circle->radius_mm, circle->radius_mm);
        return {circle->centre - radius, circle->centre + radius};
    }
    Point2 from = std::get<Path>(contour).start;
    box.extend(from);
    for (const Segment& segment : std::get<Path>(contour).segments) {
        if (segment.end != from) box.extend(box_of(curve_of(from, segment)));
        from = segment.end;
    }
    return box;
}

Meetings meetings(const Curve& a, const Curve& b) {
    // In the frame of the more curved one, from whose middle its numbers are exact. With u = k_v / k_u, v - u times the
    // circle is a line that passes through both meetings: it meets the circle where both curves do.
    const bool swap = std::abs(a.curvature_per_mm) < std::abs(b.curvature_per_mm);
    const Curve &bent = swap ? b : a, &other = swap ? a : b;
    const Implicit u = seen_from(bent.middle, bent), v = seen_from(bent.middle, other);
    const double ratio = u.k == 0 ? 0 : v.k / u.k;
    const Vector2 normal = v.m - ratio * u.m;
    const double size2 = normal.squaredNorm();
    if (!(size2 > 0)) return {};
    const Vector2 foot = -(v.c - ratio * u.c) / (2 * size2) * normal;
    const Vector2 along = left_of(normal) / std::sqrt(size2);
    // k s^2 + 2 b s + f = 0
    const double slope = u.m.dot(along);
    const double value = u.k * foot.squaredNorm() + 2 * u.m.dot(foot);
    const double inner = slope * slope - u.k * value;
    Meetings found;
    const auto add = [&](double s) {
        const Point2 point = bent.middle + foot + s * along;
        if (!point.allFinite()) return;
        found.points[static_cast<std::size_t>(found.count++)] = point;
    };
    if (inner <= 0) {
        if (u.k != 0) add(-slope / u.k);
        return found;
    }
    const double q = -(slope + std::copysign(std::sqrt(inner), slope));
    add(value / q);
    if (u.k != 0) add(q / u.k);
    return found;
}

}  // namespace lyr::region
