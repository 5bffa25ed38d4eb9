// How often contours wind around a point, counted over the input as it was given.

#pragma once

#include "kernel/region/arrangement.h"
#include "kernel/region/box_tree.h"

namespace lyr::region {

class WindingCount {
public:
    // Both must outlive it; the sources are those of the inputs.
    WindingCount(std::span<const Input> inputs, std::span<const Source> sources);

    // Along a ray to the right. A curve's end is above it or not, never on it.
    Winding at(const Point2& point) const;

    // Whether a curve passes the point within a distance.
    bool is_near(const Point2& point, double within_mm) const;

private:
    std::span<const Input> inputs_;
    std::span<const Source> sources_;
    BoxTree tree_;
};

}  // namespace lyr::region
