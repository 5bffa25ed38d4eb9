// B-spline curves, rational or not: what curve.h promises, for this one type.
//
// Contract: that of curve.h. Besides:
//  1. bezier_pieces(c, a, b) joined are the curve between a and b (a < b, in the domain); each lies in the convex
//     hull of its control points.
//  2. invert finds the nearest point of the whole curve, not the nearest of a neighbourhood.

#pragma once

#include <vector>

#include "kernel/geometry/curve.h"

namespace lyr {

Point3 evaluate(const BSplineCurve& curve, double t);
Vector3 derivative(const BSplineCurve& curve, double t);
PointAndTangent point_and_tangent(const BSplineCurve& curve, double t);
double invert(const BSplineCurve& curve, const Point3& point);
std::vector<double> height_extrema(const BSplineCurve& curve, double from, double to);
double parameter_at_height(const BSplineCurve& curve, double from, double to, double z_mm);

// A polynomial piece in homogeneous Bernstein form: (w x, w y, w z, w).
struct BezierPiece {
    double from, to;
    std::vector<Eigen::Vector4d> control_points;
};

std::vector<BezierPiece> bezier_pieces(const BSplineCurve& curve, double from, double to);

// The same points, met in the other direction, over the same domain (to round-off).
BSplineCurve reversed(BSplineCurve curve);

// The same curve of a higher degree (or, if it is of that degree already, as it is).
BSplineCurve elevated(const BSplineCurve& curve, int degree);

// One after the other, both of one degree and clamped at their ends; the second one's knots are moved to follow.
BSplineCurve joined(BSplineCurve first, BSplineCurve second);

}  // namespace lyr
