// Curves of edges: evaluate, differentiate, invert, split where the height turns.
//
// Contract
//  1. evaluate(c, t) is defined for every finite t of an elementary curve; a B-spline is clamped to its
//     domain unless it is closed, where t wraps around.
//  2. invert(c, p) is a parameter of the curve's point nearest to p. For a point of the curve,
//     |evaluate(c, invert(c, p)) - p| <= resolution_mm.
//  3. height_extrema(c, a, b) is every parameter strictly between a and b at which z has a local extremum,
//     in order from a to b (b may be smaller than a). Between neighbours, z is monotone. What counts is a turn by
//     more than resolution_mm: a stretch on which z is constant to that has no extrema inside, and one that rises
//     over an end by less is taken to be at the end.
//  4. parameter_at_height(c, a, b, z) is the parameter between a and b with that height, where z is monotone
//     on [a, b] and the ends' heights bracket it; the returned point's height is within resolution_mm / 100 of z.
//     Where the ends do not bracket it (a vertex off its curve), the nearer end is returned.
//
//  5. Axes may be left-handed (a mirrored part): every function holds for them.
//  6. evaluate(transformed(c, T), t) = T * evaluate(c, t), save for a line under a T that scales: its parameter is
//     a length, and scales with it.
//
// Parameters: Line: millimetres from its origin. Circle, Ellipse: the angle of ISO 10303-42 (eccentric anomaly
// for the ellipse). Parabola, Hyperbola: those of ISO 10303-42, without unit. B-spline: its knots' parameter.

#pragma once

#include <variant>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr {

struct Line {
    Point3 origin;
    Vector3 direction;  // unit length
};

struct Circle {
    Frame frame;  // centre, plane x-y, angle from x to y
    double radius_mm;
};

struct Ellipse {
    Frame frame;
    double semi_x_mm, semi_y_mm;
};

// origin + focal (u^2 x + 2 u y)
struct Parabola {
    Frame frame;
    double focal_mm;
};

// origin + semi_x cosh(u) x + semi_y sinh(u) y
struct Hyperbola {
    Frame frame;
    double semi_x_mm, semi_y_mm;
};

// A closed one ends where it starts; its knots need not be periodic.
struct BSplineCurve {
    int degree;                 // >= 1
    std::vector<double> knots;  // with multiplicity: control_points.size() + degree + 1 of them
    std::vector<Point3> control_points;
    std::vector<double> weights;  // positive; empty: all one
    bool closed = false;

    double domain_start() const { return knots[static_cast<std::size_t>(degree)]; }
    double domain_end() const { return knots[control_points.size()]; }
};

using Curve = std::variant<Line, Circle, Ellipse, Parabola, Hyperbola, BSplineCurve>;

Point3 evaluate(const Curve& curve, double t);
Vector3 derivative(const Curve& curve, double t);

// Both at the price of one.
struct PointAndTangent {
    Point3 point;
    Vector3 tangent;  // the derivative
};
PointAndTangent point_and_tangent(const Curve& curve, double t);

// Of a closed curve: within one period, for angles in (-pi, pi], for a B-spline in its domain.
double invert(const Curve& curve, const Point3& point);

// The parameter length after which the curve repeats; 0 for one that does not.
double period(const Curve& curve);

std::vector<double> height_extrema(const Curve& curve, double from, double to);
double parameter_at_height(const Curve& curve, double from, double to, double z_mm);

// The linear part may rotate, mirror and scale uniformly; lengths, radii and control points scale with it.
Curve transformed(const Curve& curve, const Eigen::Affine3d& transform);

}  // namespace lyr
