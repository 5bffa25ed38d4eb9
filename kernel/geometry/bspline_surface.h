// B-spline surfaces, rational or not; what extrusions and revolutions become too.
//
// Contract
//  1. Parameters are those of the knots; evaluate() and partials() clamp them to the domain unless the surface is
//     closed that way, where they wrap around.
//  2. bezier_patches() together are the surface, knot span by knot span; each lies in the convex hull of its
//     control points. Neighbours have the control points of their common border to the last bit.
//  3. invert(s, p) are the parameters of the point of the whole surface that is nearest to p, if not by less than a
//     millionth of the distance, or of one that is within `enough_mm`; invert_near() finds the nearest one in the neighbourhood of a guess.
//     |evaluate(s, invert(s, p)) - p| <= resolution_mm for p on s.
//  4. normal() is along d/du x d/dv, against it if `mirrored`, and where these vanish (a pole) the limit from
//     inside the domain.
//  5. extruded(), revolved() and rational() are exact, not approximations. So is transformed(), which may rotate,
//     mirror and scale uniformly; parameters stay.
//  6. as_plane() is the plane that all control points lie in within resolution_mm, with the surface's normal.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kernel/geometry/curve.h"
#include "kernel/geometry/vector.h"

namespace lyr {

struct Plane;

// Modellers stop below 30, and evaluation counts on it to need no memory.
inline constexpr int highest_surface_degree = 31;

struct BSplineSurface {
    int degree_u, degree_v;                   // from 1 to highest_surface_degree
    std::size_t count_u, count_v;             // of control points
    std::vector<double> knots_u, knots_v;     // with multiplicity: count + degree + 1 of them
    std::vector<Point3> control_points;       // that of (i, j) at [i * count_v + j]
    std::vector<double> weights;              // positive, in the same order; empty: all one
    bool closed_u = false, closed_v = false;  // the first and last line of it are the same points
    bool mirrored = false;

    double start_u() const { return knots_u[static_cast<std::size_t>(degree_u)]; }
    double end_u() const { return knots_u[count_u]; }
    double start_v() const { return knots_v[static_cast<std::size_t>(degree_v)]; }
    double end_v() const { return knots_v[count_v]; }
};

struct Partials {
    Point3 point;
    Vector3 du, dv;
};

Point3 evaluate(const BSplineSurface& surface, const Point2& uv);
Partials partials(const BSplineSurface& surface, const Point2& uv);
Vector3 normal(const BSplineSurface& surface, const Point2& uv);
Point2 invert(const BSplineSurface& surface, const Point3& point, double enough_mm = 0);
Point2 invert_near(const BSplineSurface& surface, const Point3& point, const Point2& guess);
BSplineSurface transformed(BSplineSurface surface, const Eigen::Affine3d& transform);

// One polynomial piece in homogeneous Bernstein form, (w x, w y, w z, w), that of (i, j) at [i * (degree_v + 1) + j].
struct BezierPatch {
    double from_u, to_u, from_v, to_v;
    int degree_u, degree_v;
    std::vector<Eigen::Vector4d> control_points;
};

// Knot spans of no width have none. Ordered by u, then v: `spans_v` of them for each span of u.
struct BezierPatches {
    std::size_t spans_u = 0, spans_v = 0;
    std::vector<BezierPatch> patches;
};
BezierPatches bezier_patches(const BSplineSurface& surface);

// A curve between two parameters (from < to) as a B-spline over these parameters' order; the parameter of a conic
// changes. A line becomes one piece of degree 1, a conic rational pieces of degree 2 that turn less than a right
// angle and a half each.
BSplineCurve rational(const Curve& curve, double from, double to);

// u along the curve, v from 0 to 1 along `sweep`.
BSplineSurface extruded(const BSplineCurve& curve, const Vector3& sweep);

// u around the axis (the frame's z, a full turn from its x towards y), v along the curve.
BSplineSurface revolved(const BSplineCurve& curve, const Frame& axis);

std::optional<Plane> as_plane(const BSplineSurface& surface);

}  // namespace lyr
