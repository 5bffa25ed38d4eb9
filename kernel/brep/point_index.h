// Points by place: a tree that finds those in a box.
//
// Contract
//  1. within(box, visit) calls visit(i) once for each point i in the box, borders included, in no particular order.
//  2. Building takes time n log n, a query log n besides the points found, wherever the points lie.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr {

class PointIndex {
public:
    explicit PointIndex(std::vector<Point3> points);

    template <class Visit>
    void within(const Eigen::AlignedBox3d& box, Visit visit) const {
        if (!order_.empty()) within(box, 0, order_.size(), 0, visit);
    }

private:
    // The middle of each range divides it: the points before it are not above it along the axis, those behind it not
    // below. Axes take turns.
    void build(std::size_t first, std::size_t last, int axis);

    template <class Visit>
    void within(const Eigen::AlignedBox3d& box, std::size_t first, std::size_t last, int axis,
                Visit& visit) const {
        const std::size_t middle = first + (last - first) / 2;
        const Point3& point = points_[order_[middle]];
        if (box.contains(point)) visit(order_[middle]);
        const int next = (axis + 1) % 3;
        if (first < middle && box.min()[axis] <= point[axis]) {
            within(box, first, middle, next, visit);
        }
        if (middle + 1 < last && box.max()[axis] >= point[axis]) {
            within(box, middle + 1, last, next, visit);
        }
    }

    std::vector<Point3> points_;
    std::vector<std::uint32_t> order_;
};

// All that is within a distance along each axis.
inline Eigen::AlignedBox3d box_around(const Point3& point, double reach_mm) {
    const Vector3 reach = Vector3::Constant(reach_mm);
    return {Point3(point - reach), Point3(point + reach)};
}

}  // namespace lyr
