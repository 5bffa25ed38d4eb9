// Infill of straight lines: where the rows of each pattern lie, and what is made of them.

#pragma once

#include <vector>

#include "kernel/toolpath/infill.h"

namespace lyr {

// Links of strands, in spacings of the pattern: along a boundary that leans by 15 degrees against straight rows. Longer
// ones would print as much as the lines that they save a travel between.
inline constexpr double longest_link = 4;

// One grid a direction; none for a pattern that is not made of straight lines.
std::vector<RowGrid> row_grids(const InfillRequest& request);

// Rows as runs, with straight links.
void fill_with_runs(std::span<const BoundaryPiece> boundary, const RowGrid& grid,
                    const InfillRequest& request, Fill& fill);

// Rows of all directions as strands, linked along the boundary.
void fill_with_strands(std::span<const BoundaryPiece> boundary, std::span<const RowGrid> grids,
                       const InfillRequest& request, Fill& fill);

}  // namespace lyr
