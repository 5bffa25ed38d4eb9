// Elementary surfaces: each is solved in its own frame, where inversion is at most two arc tangents. And the dispatch
// to B-splines.

#include "kernel/geometry/surface.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/angle.h"

namespace lyr {

namespace {

Vector3 radial(const Frame& frame, double u) {
    return std::cos(u) * frame.x + std::sin(u) * frame.y;
}

Point3 point_at(const Plane& s, const Point2& uv) {
    return s.frame.to_global({uv.x(), uv.y(), 0});
}
Point3 point_at(const Cylinder& s, const Point2& uv) {
    return s.frame.origin + s.radius_mm * radial(s.frame, uv.x()) + uv.y() * s.frame.z;
}
Point3 point_at(const Cone& s, const Point2& uv) {
    const double radius = s.radius_mm + uv.y() * std::tan(s.half_angle_rad);
    return s.frame.origin + radius * radial(s.frame, uv.x()) + uv.y() * s.frame.z;
}
Point3 point_at(const Sphere& s, const Point2& uv) {
    return s.frame.origin + s.radius_mm * (std::cos(uv.y()) * radial(s.frame, uv.x()) +
                                           std::sin(uv.y()) * s.frame.z);
}
Point3 point_at(const Torus& s, const Point2& uv) {
    return s.frame.origin + (s.major_mm + s.minor_mm * std::cos(uv.y())) * radial(s.frame, uv.x()) +
           s.minor_mm * std::sin(uv.y()) * s.frame.z;
}
Point3 point_at(const SharedBSplineSurface& s, const Point2& uv) {
    return evaluate(*s, uv);
}

Vector3 normal_at(const Plane& s, const Point2&) {
    return s.frame.z;
}
Vector3 normal_at(const Cylinder& s, const Point2& uv) {
    return radial(s.frame, uv.x());
}
Vector3 normal_at(const Cone& s, const Point2& uv) {
    return std::cos(s.half_angle_rad) * radial(s.frame, uv.x()) -
           std::sin(s.half_angle_rad) * s.frame.z;
}
Vector3 normal_at(const Sphere& s, const Point2& uv) {
    return std::cos(uv.y()) * radial(s.frame, uv.x()) + std::sin(uv.y()) * s.frame.z;
}
Vector3 normal_at(const Torus& s, const Point2& uv) {
    return std::cos(uv.y()) * radial(s.frame, uv.x()) + std::sin(uv.y()) * s.frame.z;
}
Vector3 normal_at(const SharedBSplineSurface& s, const Point2& uv) {
    return normal(*s, uv);
}

Point2 parameters_of(const Plane& s, const Point3& point) {
    return s.frame.to_local(point).head<2>();
}
Point2 parameters_of(const Cylinder& s, const Point3& point) {
    const Point3 local = s.frame.to_local(point);
    return {direction_angle(local.y(), local.x()), local.z()};
}
Point2 parameters_of(const Cone& s, const Point3& point) {
    const Point3 local = s.frame.to_local(point);
    const double sine = std::sin(s.half_angle_rad), cosine = std::cos(s.half_angle_rad);
    const double outward = std::hypot(local.x(), local.y()) - s.radius_mm;
    const double height = cosine * (outward * sine + local.z() * cosine);
    const double apex = -s.radius_mm * cosine / sine;
    return {direction_angle(local.y(), local.x()), std::max(height, apex)};
}
Point2 parameters_of(const Sphere& s, const Point3& point) {
    const Point3 local = s.frame.to_local(point);
    return {direction_angle(local.y(), local.x()),
            std::atan2(local.z(), std::hypot(local.x(), local.y()))};
}
Point2 parameters_of(const Torus& s, const Point3& point) {
    const Point3 local = s.frame.to_local(point);
    const double distance = std::hypot(local.x(), local.y());
    if (!beyond_axis(s, point)) {
        return {direction_angle(local.y(), local.x()),
                direction_angle(local.z(), distance - s.major_mm)};
    }
    return {direction_angle(-local.y(), -local.x()),
            direction_angle(local.z(), -distance - s.major_mm)};
}
Point2 parameters_of(const SharedBSplineSurface& s, const Point3& point) {
    return invert(*s, point);
}

double uniform_scale(const Eigen::Affine3d& transform) {
    return std::cbrt(std::abs(transform.linear().determinant()));
}

}  // namespace

bool beyond_axis(const Torus& torus, const Point3& point) {
    const Point3 local = torus.frame.to_local(point);
    const double distance = std::hypot(local.x(), local.y());
    const double from_near = std::hypot(distance - torus.major_mm, local.z());
    const double from_far = std::hypot(distance + torus.major_mm, local.z());
    return std::abs(from_near - torus.minor_mm) > std::abs(from_far - torus.minor_mm);
}

Point3 evaluate(const Surface& surface, const Point2& uv) {
    return std::visit([&](const auto& s) { return point_at(s, uv); }, surface);
}

Vector3 normal(const Surface& surface, const Point2& uv) {
    return std::visit([&](const auto& s) { return normal_at(s, uv); }, surface);
}

Point2 invert(const Surface& surface, const Point3& point) {
    return std::visit([&](const auto& s) { return parameters_of(s, point); }, surface);
}

Frame transformed(const Frame& frame, const Eigen::Affine3d& transform) {
    const auto& linear = transform.linear();
    return {transform * frame.origin, (linear * frame.x).normalized(),
            (linear * frame.y).normalized(), (linear * frame.z).normalized()};
}

Surface transformed(const Surface& surface, const Eigen::Affine3d& transform) {
    const double scale = uniform_scale(transform);
    return std::visit(
        [&](auto s) -> Surface {
            using T = decltype(s);
            if constexpr (std::is_same_v<T, SharedBSplineSurface>) {
                return std::make_shared<const BSplineSurface>(transformed(*s, transform));
            } else {
                s.frame = transformed(s.frame, transform);
                if constexpr (std::is_same_v<T, Torus>) {
                    s.major_mm *= scale;
                    s.minor_mm *= scale;
                } else if constexpr (!std::is_same_v<T, Plane>) {
                    s.radius_mm *= scale;
                }
                return s;
            }
        },
        surface);
}

}  // namespace lyr
