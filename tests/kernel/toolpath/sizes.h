// What tests of toolpaths print with, and how far results may be off.

#pragma once

#include "kernel/region/regions.h"
#include "kernel/toolpath/walls.h"

namespace lyr::testing {

inline constexpr double width_mm = 0.45, height_mm = 0.2;
inline constexpr double allowed_mm = 1e-4;
// Of walls and of strands along centre lines.
inline constexpr double wall_allowed_mm = 0.00125;
// Of infill and of travels.
inline constexpr double infill_allowed_mm = 0.005;

inline const Point2 origin = Point2::Zero();

inline WallRequest wall_request(std::uint32_t count) {
    return {.count = count,
            .width_mm = width_mm,
            .height_mm = height_mm,
            .allowed_mm = wall_allowed_mm};
}

// Of ribs, as they may lie in a part.
inline const Motion rib_motions[] = {
    {}, {0.3, {1, 2}}, {2.1, {-40, 7}, true}, {pi / 2, {0, 0}}, {-1, {100, 80}, true}};

}  // namespace lyr::testing
