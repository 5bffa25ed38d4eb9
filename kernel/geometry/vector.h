// The vectors of the kernel: Eigen's, under the names of the field. Lengths are millimetres.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lyr {

using Point3 = Eigen::Vector3d;
using Vector3 = Eigen::Vector3d;
using Point2 = Eigen::Vector2d;
using Vector2 = Eigen::Vector2d;

// A quarter turn.
inline Vector2 left_of(const Vector2& direction) {
    return {-direction.y(), direction.x()};
}
inline Vector2 right_of(const Vector2& direction) {
    return {direction.y(), -direction.x()};
}

// A local coordinate system. The axes are orthonormal; after a mirroring they are left-handed.
struct Frame {
    Point3 origin = Point3::Zero();
    Vector3 x = Vector3::UnitX();
    Vector3 y = Vector3::UnitY();
    Vector3 z = Vector3::UnitZ();

    Point3 to_local(const Point3& point) const {
        const Vector3 offset = point - origin;
        return {offset.dot(x), offset.dot(y), offset.dot(z)};
    }
    Point3 to_global(const Point3& local) const {
        return origin + local.x() * x + local.y() * y + local.z() * z;
    }
};

}  // namespace lyr
