// Feet of points on a B-spline surface, one after the other along a path.
//
// Contract
//  1. The first foot is the nearest point of the whole surface, or one that is not farther off than `doubtful_mm`. The
//     next ones are sought from the foot before, by a few steps in tangent planes, and found to rough_foot of the way
//     from there; where that leads to a foot farther off than that, on the whole surface again.

#pragma once

#include <optional>

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

// What a step in space is in the parameters, as far as it is along the surface.
Vector2 parameter_step(const Partials& at, const Vector3& step);

inline constexpr double rough_foot = 1e-4;

class SurfaceFoot {
public:
    explicit SurfaceFoot(const BSplineSurface& surface) : surface_(&surface) {}

    void move_to(const Point3& point, double doubtful_mm);

    const Point2& uv() const { return uv_; }
    const Partials& partials() const { return at_; }
    double distance_mm() const { return distance_mm_; }

private:
    bool approach(const Point3& point);
    void set(const Point3& point, const Point2& uv);

    const BSplineSurface* surface_;
    bool is_first_ = true;
    Point2 uv_ = Point2::Zero();
    Partials at_{Point3::Zero(), Vector3::Zero(), Vector3::Zero()};
    double distance_mm_ = 0;
};

}  // namespace lyr
