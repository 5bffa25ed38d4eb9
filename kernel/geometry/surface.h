// Surfaces of faces: evaluate, differentiate, invert.
//
// Contract
//  1. Parameters are those of ISO 10303-42: angles in radians, lengths in millimetres.
//       plane     (x, y)          cylinder (angle, height)      cone (angle, height along the axis)
//       sphere    (longitude, latitude)                         torus (around the axis, around the tube)
//       B-spline  see bspline_surface.h
//  2. normal(s, uv) is the unit normal that ISO 10303-42 gives the surface: away from the axis, centre or tube
//     centre; a plane's z; for a B-spline that of d/du x d/dv. It is geometric: mirroring a model mirrors it with
//     its points.
//  3. invert(s, p) are the parameters of the point of s nearest to p, angles in (-pi, pi].

#pragma once

#include <memory>
#include <variant>

#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/vector.h"

namespace lyr {

struct Plane {
    Frame frame;
};

struct Cylinder {
    Frame frame;  // z is the axis
    double radius_mm;
};

// radius = radius_mm + height * tan(half_angle); the nappe with positive radius is meant.
struct Cone {
    Frame frame;
    double radius_mm;       // at the frame's origin, >= 0
    double half_angle_rad;  // in (0, pi/2)
};

struct Sphere {
    Frame frame;
    double radius_mm;
};

// A tube wider than its ring (minor > major) crosses the axis, and the torus has two sheets that meet in two poles:
// an outer one, dented at the poles, and an inner one like a lemon. A face lies on one of them.
struct Torus {
    Frame frame;
    double major_mm, minor_mm;
    bool inner_sheet = false;
};

// Shared, because faces are copied and moved about while their control points are not looked at.
using SharedBSplineSurface = std::shared_ptr<const BSplineSurface>;

using Surface = std::variant<Plane, Cylinder, Cone, Sphere, Torus, SharedBSplineSurface>;

// Whether the point is nearest to where the tube has crossed the axis, which it does if it is wider than the ring.
// There d/du x d/dv points towards the tube's centre, against normal().
bool beyond_axis(const Torus& torus, const Point3& point);

Point3 evaluate(const Surface& surface, const Point2& uv);
Vector3 normal(const Surface& surface, const Point2& uv);
Point2 invert(const Surface& surface, const Point3& point);

// The linear part may rotate, mirror and scale uniformly.
Surface transformed(const Surface& surface, const Eigen::Affine3d& transform);
Frame transformed(const Frame& frame, const Eigen::Affine3d& transform);

}  // namespace lyr
