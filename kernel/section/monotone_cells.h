// A Bezier patch divided into cells on which the level curves of the height are simple.
//
// Contract
//  1. The cells tile the patch's parameter rectangle; their borders are shared to the last bit.
//  2. On a cell of kind `graph_over_u`, d/dv of the height has one sign, so a level curve is a graph over u, of which
//     every crossing of the border is an end; on `graph_over_v` the same with u and v exchanged; `both` is both. The sign
//     is `rises`. It is proved by Bernstein coefficients, not sampled.
//  3. A cell that cannot be divided into such (it holds a maximum, minimum or saddle, or lies level) is divided until
//     its height varies by less than flat_cell_mm, and is `flat`: whatever joins the crossings of its border
//     is a section within that height.
//
// Method: Bernstein subdivision (Sederberg & Meyers, "Loop detection in surface patch intersections", CAGD 5, 1988,
// bound normals the same way), along one parameter at a time, through a zero of the derivative where the patch's middle
// line has one: ridges along a parameter line then become borders after one division.

#pragma once

#include <cstdint>
#include <vector>

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

// Ten times resolution_mm: a plane within it of a maximum cuts a ring that no printer can see, wherever it runs.
inline constexpr double flat_cell_mm = 1e-6;

enum class CellKind : std::uint8_t { graph_over_u, graph_over_v, both, flat };

struct MonotoneCell {
    double from_u, to_u, from_v, to_v;
    CellKind kind;
    bool rises_u, rises_v;  // of the derivatives that have one sign
    std::uint32_t patch;
    // Of a graph over u, |dv/du| on its level curves is no greater; over v, |du/dv|.
    double steepest;
};

// Appends the cells of a patch.
void append_monotone_cells(const BezierPatch& patch, std::uint32_t index,
                           std::vector<MonotoneCell>& cells);

}  // namespace lyr
