// Parallel lines that fill a region bounded by lines and arcs, clipped exactly.
//
// Contract: that of rows.h. Row k is at (k + 1/2) * pitch from the origin of the plane.
//
// Rows run along `direction`; their offset is measured to the left of it.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/contour/contour.h"

namespace lyr {

// Along the row's direction, from the foot of the origin's perpendicular; start < end.
struct HatchSpan {
    double start_mm, end_mm;
};

struct Hatch {
    Vector2 direction;
    double first_offset_mm = 0;  // of row 0
    double pitch_mm = 0;
    std::vector<std::uint32_t> row_start;  // spans of row k: [row_start[k], row_start[k + 1])
    std::vector<HatchSpan> spans;

    std::size_t row_count() const { return row_start.empty() ? 0 : row_start.size() - 1; }
};

Hatch hatch(std::span<const Contour> contours, double angle_rad, double pitch_mm);

}  // namespace lyr
