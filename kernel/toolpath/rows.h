// Parallel rows across a region, with what they meet of its boundary: the common ground of hatches and of sparse lines.
//
// Contract
//  1. A row meets a contour where the contour, cut into curves that only rise or only fall across the rows,
//     changes sides; a curve's end is above a row or not, never on it. So rows cross every closed contour an even
//     number of times, and a corner that touches a row needs no special case.
//  2. Crossings with lines and arcs are in closed form: no arc becomes a polygon.
//  3. Inside is where the winding number is positive: overlapping regions are one.
//  4. Row k is at (k + 1/2 + shift) * pitch from the origin of the plane, whatever the region: layers stay in register.
//
// Everything is in the rows' own coordinates: x along `direction`, y to the left of it.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

// A part of a contour that meets each row at most once.
struct RowCurve {
    Point2 low, high;
    bool falls;  // in the contour's direction: then the region is to the right of it
    bool is_arc, right_half;
    Point2 centre;
    double radius_mm;
    std::uint32_t piece;                        // of the boundary
    std::uint32_t next, previous;               // of the contour
    std::uint32_t first_row = 0, last_row = 0;  // meets the rows [first_row, last_row)
};

struct RowEnd {
    double x_mm;
    std::uint32_t curve;
};

struct RowSpan {
    RowEnd start, end;
};

struct RowGrid {
    double angle_rad = 0;
    double pitch_mm = 0;
    double shift = 0;  // of the rows, in pitches
};

struct Rows {
    Vector2 direction = Vector2::UnitX();
    double pitch_mm = 0;
    double first_y_mm = 0;                   // of row 0
    std::vector<RowCurve> curves{};          // in the order of the boundary
    std::vector<std::uint32_t> row_start{};  // spans of row k: [row_start[k], row_start[k + 1])
    std::vector<RowSpan> spans{};            // of a row, with rising x

    std::uint32_t count() const {
        return row_start.empty() ? 0 : static_cast<std::uint32_t>(row_start.size() - 1);
    }
    double y_mm(std::uint32_t row) const { return first_y_mm + row * pitch_mm; }
    std::span<const RowSpan> spans_of(std::uint32_t row) const {
        return {spans.data() + row_start[row], spans.data() + row_start[row + 1]};
    }
    Point2 in_plane(double x_mm, double y_mm) const {
        return x_mm * direction + y_mm * Vector2(-direction.y(), direction.x());
    }
};

double crossing_x_mm(const RowCurve& curve, double y_mm);

// Of a row at any height, which belongs to no grid.
std::vector<RowSpan> spans_at(const Rows& rows, double y_mm);

Rows rows_across(std::span<const BoundaryPiece> boundary, const RowGrid& grid);

}  // namespace lyr
