// One line or circular arc, given by its ends and its sagitta, and what can be asked of it.
//
// Contract
//  1. The sagitta is the signed height of the arc over its chord: positive turns left (counter-clockwise from
//     start to end), zero is a line. |sagitta| may exceed half the chord (more than a semicircle).
//  2. Every answer is continuous as the sagitta goes through zero: no jump between a line and a flat arc.
//  3. enclosed area is that between the chord and the arc, positive to the right of the chord, so that
//     adding it to the polygon's area gives the area of a counter-clockwise contour.

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/geometry/vector.h"

namespace lyr {

struct Segment {
    Point2 end;
    double sagitta_mm = 0;
    friend bool operator==(const Segment&, const Segment&) = default;
};

struct ArcCircle {
    Point2 centre;
    double radius_mm;
};

inline double cross(const Vector2& a, const Vector2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

// In [0, pi].
inline double angle_between(const Vector2& a, const Vector2& b) {
    return std::abs(std::atan2(cross(a, b), a.dot(b)));
}

// The angle swept, signed, in (-2 pi, 2 pi); 0 for a line.
double sweep_rad(const Point2& start, const Segment& segment);

// None for a line.
std::optional<ArcCircle> circle_of(const Point2& start, const Segment& segment);

double length_mm(const Point2& start, const Segment& segment);
double enclosed_area_mm2(const Point2& start, const Segment& segment);

// Unit tangents in the direction of travel; the chord's direction for a line.
Vector2 start_tangent(const Point2& start, const Segment& segment);
Vector2 end_tangent(const Point2& start, const Segment& segment);

// The point at a fraction (0..1) of the segment's length.
Point2 point_at(const Point2& start, const Segment& segment, double fraction);

// A segment's whole line or circle. Measuring many points against it needs the square root of one only.
struct Carrier {
    Point2 start;
    Vector2 tangent;
    double curvature_per_mm;  // positive: the centre lies to the left
};
Carrier carrier_of(const Point2& start, const Segment& segment);

// The signed distance of a point to it: positive to the right.
inline double offset_mm(const Carrier& carrier, const Point2& point) {
    // With curvature k, q from the start and q.n along the right normal, the distance to the centre over the
    // radius is sqrt(1 + 2 k q.n + k^2 q^2); rationalised, less one and over k, it is defined for k = 0 too.
    const Vector2 offset = point - carrier.start;
    const double right = cross(offset, carrier.tangent);
    const double square = carrier.curvature_per_mm * offset.squaredNorm();
    const double ratio2 = 1 + carrier.curvature_per_mm * (2 * right + square);
    return (2 * right + square) / (1 + std::sqrt(std::max(0.0, ratio2)));
}
double offset_mm(const Point2& start, const Segment& segment, const Point2& point);

// The distance of a point to the segment.
double distance_mm(const Point2& start, const Segment& segment, const Point2& point);

// The arc of a circle from start to end that sweeps `sweep` (not a multiple of 2 pi).
Segment arc_with_sweep(const Point2& start, const Point2& end, double sweep);

}  // namespace lyr
