// A line or an arc that rises or falls all along, as the arrangement of a region takes it.
//
// Contract
//  1. A curve is seen from its middle: the tangent there, the curvature, the half length. Nothing goes through the
//     circle's centre, so an arc as flat as one likes is as good as a line.
//  2. for_monotone_curves() cuts a contour at the lowest and highest points of its circles. No curve turns by more
//     than half a circle; one curve's end is the next one's start, bit for bit.
//  3. meetings() are the points where the whole lines or circles meet; a circle that meets nothing gives its point that
//     is nearest to the other. Whoever asks checks whether that is near enough, and whether the curves go so far.

#pragma once

#include <array>
#include <functional>

#include "kernel/contour/contour.h"

namespace lyr::region {

using Box2 = Eigen::AlignedBox2d;

struct Curve {
    Point2 start, end, middle;
    Vector2 tangent;              // unit, at the middle
    double curvature_per_mm = 0;  // positive turns left
    double half_mm = 0;           // half the length
};

// A segment as one curve, not cut yet. Its ends must differ.
Curve curve_of(const Point2& start, const Segment& segment);

// What follows start to end in the contour's direction, with the index of its segment (0 for a full circle).
void for_monotone_curves(const Contour& contour,
                         const std::function<void(const Curve&, std::size_t segment)>& take);

// The length from the middle to the point's foot on the whole line or circle, negative towards the start.
double along_mm(const Curve& curve, const Point2& point);

// The signed distance to the whole line or circle, positive to the right.
double across_mm(const Curve& curve, const Point2& point);

Point2 point_on(const Curve& curve, double along);
Vector2 tangent_at(const Curve& curve, double along);

// At the point's foot.
Vector2 tangent_beside(const Curve& curve, const Point2& point);

// Whether the curve passes the point within a distance.
bool passes(const Curve& curve, const Point2& point, double within_mm);

Box2 box_of(const Curve& curve);
Box2 box_of(const Contour& contour);

// A box that holds the curve, of no more than half a circle: found faster than the least one, and hardly larger for a
// flat arc.
inline Box2 bounds_of(const Curve& curve) {
    // The sagitta is 1 - cos(k half) over k.
    const double sagitta = std::abs(curve.curvature_per_mm) * curve.half_mm * curve.half_mm / 2;
    const Vector2 margin(sagitta, sagitta);
    return {curve.start.cwiseMin(curve.end) - margin, curve.start.cwiseMax(curve.end) + margin};
}

struct Meetings {
    std::array<Point2, 2> points{Point2::Zero(), Point2::Zero()};
    int count = 0;
};
Meetings meetings(const Curve& a, const Curve& b);

}  // namespace lyr::region
