// Newton's method without second derivatives, from a foot to the next.

#include "kernel/brep/surface_foot.h"

#include <algorithm>

#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

Vector2 parameter_step(const Partials& at, const Vector3& step) {
    const double uu = at.du.squaredNorm(), uv = at.du.dot(at.dv), vv = at.dv.squaredNorm();
    const double u = at.du.dot(step), v = at.dv.dot(step);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return Vector2::Zero();
    return Vector2(vv * u - uv * v, uu * v - uv * u) / determinant;
}

void SurfaceFoot::move_to(const Point3& point, double doubtful_mm) {
    if (!is_first_) {
        if (!approach(point)) set(point, invert_near(*surface_, point, uv_));
        if (distance_mm_ <= doubtful_mm) return;
    }
    is_first_ = false;
    set(point, invert(*surface_, point, doubtful_mm));
}

bool SurfaceFoot::approach(const Point3& point) {
    constexpr int most_steps = 3;
    const double near_mm = std::max(rough_foot * (point - at_.point).norm(), resolution_mm);
    Vector2 step = parameter_step(at_, point - at_.point);
    for (int i = 0; i < most_steps; ++i) {
        set(point, into_domain(*surface_, uv_ + step));
        step = parameter_step(at_, point - at_.point);
        if ((step.x() * at_.du + step.y() * at_.dv).norm() <= near_mm) return true;
    }
    return false;
}

void SurfaceFoot::set(const Point3& point, const Point2& uv) {
    uv_ = uv;
    at_ = lyr::partials(*surface_, uv);
    distance_mm_ = (at_.point - point).norm();
}

}  // namespace lyr
