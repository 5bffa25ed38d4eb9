// A k-d tree without nodes: the order of the points is the tree.

#include "kernel/brep/point_index.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lyr {

PointIndex::PointIndex(std::vector<Point3> points)
    : points_(std::move(points)), order_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, order_.size(), 0);
}

void PointIndex::build(std::size_t first, std::size_t last, int axis) {
    if (last - first < 2) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto begin = order_.begin();
    std::nth_element(
        begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
        begin + static_cast<std::ptrdiff_t>(last),
        [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    build(first, middle, (axis + 1) % 3);
    build(middle + 1, last, (axis + 1) % 3);
}

}  // namespace lyr
