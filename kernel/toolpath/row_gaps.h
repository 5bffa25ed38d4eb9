// Where rows leave gaps at the boundary: beyond the last row of a part, beside edges that run along the rows, in parts
// that no row meets.
//
// Contract
//  1. Where the boundary turns back between two rows and is farther than `beyond_mm` from the row that faces it, the
//     result goes along the boundary. What is left between them and the rows is no wider than that.
//  2. An island between two rows is crossed at half its height.
//  3. Along the boundary nothing is shorter than `shortest_mm`. Islands without length at that height are counted.

#pragma once

#include <cstddef>
#include <vector>

#include "kernel/toolpath/rows.h"

namespace lyr {

struct GapLimits {
    double beyond_mm = 0;
    double shortest_mm = 0;
};

struct GapLines {
    std::vector<Path> paths{};
    std::size_t islands_left_out = 0;
};

GapLines gap_lines(std::span<const BoundaryPiece> boundary, const Rows& rows,
                   const GapLimits& limits);

}  // namespace lyr
