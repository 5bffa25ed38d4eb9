// With chord c and sagitta s: tan(sweep / 4) = 2 s / c and radius = (c^2 / 4 + s^2) / (2 s). The first is exact
// and stable for every arc; what the second loses for flat arcs is avoided by not going through the radius.
// Most arcs of a print are flat; a power series answers for them faster than the library does for all.

#include "kernel/contour/arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lyr {
namespace {

Vector2 rotated(const Vector2& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

// Of 2 s / c, below which the series are exact to rounding.
constexpr double flat = 1.0 / 16;

// 1 - atan(x) / x over x^2, for |x| <= flat.
double flat_atan_rest(double x2) {
    return 1.0 / 3 - x2 * (1.0 / 5 - x2 * (1.0 / 7 - x2 * (1.0 / 9 - x2 * (1.0 / 11 - x2 / 13))));
}

// atan(x) / x for |x| <= flat.
double flat_atan_share(double x) {
    return 1 - x * x * flat_atan_rest(x * x);
}

}  // namespace

double sweep_rad(const Point2& start, const Segment& segment) {
    if (segment.sagitta_mm == 0) return 0;
    const double c = (segment.end - start).norm(), s2 = 2 * segment.sagitta_mm;
    if (std::abs(s2) <= flat * c) return 4 * s2 / c * flat_atan_share(s2 / c);
    return 4 * std::atan(s2 / c);
}

std::optional<ArcCircle> circle_of(const Point2& start, const Segment& segment) {
    if (segment.sagitta_mm == 0) return std::nullopt;
    const Vector2 chord = segment.end - start;
    const double c = chord.norm(), s = segment.sagitta_mm;
    const double radius = (c * c / 4 + s * s) / (2 * s);
    const Point2 middle = 0.5 * (start + segment.end);
    return ArcCircle{middle + (radius - s) / c * left_of(chord), std::abs(radius)};
}

// The radius times the sweep, in which t = 2 s / c: c (1 + t^2) atan(t) / t.
double length_mm(const Point2& start, const Segment& segment) {
    const double c = (segment.end - start).norm(), s2 = 2 * segment.sagitta_mm;
    if (std::abs(s2) <= flat * c) {
        const double t = c == 0 ? 0 : s2 / c;
        return c * (1 + t * t) * flat_atan_share(t);
    }
    return (c * c / s2 + s2) * std::atan(s2 / c);
}

// Half the square of the radius times sweep - sin(sweep), where t = tan(sweep / 4) gives the sine; for a flat arc without
// what cancels.
double enclosed_area_mm2(const Point2& start, const Segment& segment) {
    const double c = (segment.end - start).norm(), s2 = 2 * segment.sagitta_mm;
    if (s2 == 0) return 0;
    const double t = s2 / c, t2 = t * t, rise = (1 + t2) * (1 + t2);
    if (std::abs(s2) <= flat * c) return c * s2 / 8 * (3 + t2 - flat_atan_rest(t2) * rise);
    return c * c / (8 * t2) * (rise * std::atan(t) - t * (1 - t2));
}

namespace {

// The chord turned by half the sweep, whose quarter has the tangent 2 s / c; `turn` +1: to the left.
Vector2 end_direction(const Point2& start, const Segment& segment, double turn) {
    const Vector2 chord = segment.end - start;
    const double length = chord.norm();
    if (length == 0) return Vector2::Zero();
    const double t = turn * 2 * segment.sagitta_mm / length;
    const double scale = 1 / (length * (1 + t * t));
    return scale * ((1 - t * t) * chord + 2 * t * left_of(chord));
}

}  // namespace

Vector2 start_tangent(const Point2& start, const Segment& segment) {
    return end_direction(start, segment, -1);
}

Vector2 end_tangent(const Point2& start, const Segment& segment) {
    return end_direction(start, segment, 1);
}

Point2 point_at(const Point2& start, const Segment& segment, double fraction) {
    const double sweep = sweep_rad(start, segment);
    const Vector2 chord = segment.end - start;
    if (sweep == 0) return start + fraction * chord;
    // The chord to the point at this fraction: turned back by the rest of half the sweep.
    const double half = sweep / 2;
    const double scale = std::sin(half * fraction) / std::sin(half);
    if (!std::isfinite(scale)) return start;
    return start + scale * rotated(chord, -half * (1 - fraction));
}

Carrier carrier_of(const Point2& start, const Segment& segment) {
    const double half_chord = (segment.end - start).norm() / 2, s = segment.sagitta_mm;
    return {start, start_tangent(start, segment), 2 * s / (half_chord * half_chord + s * s)};
}

double offset_mm(const Point2& start, const Segment& segment, const Point2& point) {
    return offset_mm(carrier_of(start, segment), point);
}

double distance_mm(const Point2& start, const Segment& segment, const Point2& point) {
    const bool before = (point - start).dot(start_tangent(start, segment)) < 0;
    const bool after = (point - segment.end).dot(end_tangent(start, segment)) > 0;
    // Beside the chord of more than a semicircle, a point is beside the arc unless it is past both ends.
    const bool wide = std::abs(sweep_rad(start, segment)) > std::numbers::pi;
    const bool beside = wide ? !(before && after) : !(before || after);
    if (beside) return std::abs(offset_mm(start, segment, point));
    return std::min((point - start).norm(), (point - segment.end).norm());
}

Segment arc_with_sweep(const Point2& start, const Point2& end, double sweep) {
    return {end, (end - start).norm() / 2 * std::tan(sweep / 4)};
}

}  // namespace lyr
