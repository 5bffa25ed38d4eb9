// Which part of a region a point is in.
//
// Contract: parts are numbered as the region's outer contours follow each other; a point is of the smallest one that winds
// around it, or of none (count()).
//
// Cost: n log n for the region; log n for a point and outer contour whose boxes meet, nothing if there is one part only.

#pragma once

#include <cstdint>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

class Islands {
public:
    explicit Islands(Region region);

    std::uint32_t count() const { return static_cast<std::uint32_t>(islands_.size()); }
    // Of one part only, every point is in it.
    std::uint32_t of(const Point2& point) const;

private:
    struct Island {
        std::uint32_t number;
        double area_mm2;
        region::Box2 box;
        Boundary outline;
    };
    std::vector<Island> islands_;  // by area
};

// The parts by themselves: each an outer contour and the holes in it, numbered alike. Holes in none are left out.
std::vector<std::vector<Contour>> parts_of(Region region);

}  // namespace lyr
