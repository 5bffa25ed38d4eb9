// A free-form surface prepared for all planes: monotone cells, and the pieces of their borders on which the height only
// rises or only falls.
//
// Contract
//  1. Vertices carry the height that decides on which side of a plane they are. A plane meets a border piece exactly
//     once if its ends are on different sides, else never; so the crossings on the border of a cell are even in
//     number, whatever the plane.
//  2. Pieces are shared by the two cells that they separate; across the seam of a closed surface too. A piece at
//     the rim of the surface has one cell.
//  3. Everything is a function of the surface alone.

#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/geometry/bspline_surface.h"
#include "kernel/section/bezier_patch.h"
#include "kernel/section/interval_index.h"
#include "kernel/section/monotone_cells.h"

namespace lyr {

struct MeshVertex {
    Point2 uv;
    double z_mm;
};

// Along a parameter line from vertex `from` to vertex `to`, in rising order of the running parameter.
struct BorderPiece {
    std::uint32_t from, to;
    bool along_u;
    double fixed;  // the other parameter
    double start, end;
    std::uint32_t patch;
    // The cells to the left and right of the direction from `from` to `to`, in the (u, v) plane.
    std::int32_t left = -1, right = -1;
};

struct HeightMesh {
    std::shared_ptr<const BSplineSurface> surface;
    std::vector<BezierPatch> patches;
    std::vector<QuarticPart> quartic_parts;  // of the patches
    std::vector<double> creases_u,
        creases_v;  // parameter lines across which the surface may have an edge
    std::vector<MonotoneCell> cells;
    std::vector<MeshVertex> vertices;
    std::vector<BorderPiece> pieces;
    IntervalIndex pieces_by_height;

    // Whether patches that meet there have the same tangents.
    bool is_smooth_at(const Point2& uv) const;
};

HeightMesh height_mesh(std::shared_ptr<const BSplineSurface> surface);

// The same of those patches alone that may reach out of a range of heights.
HeightMesh height_mesh_beyond(std::shared_ptr<const BSplineSurface> surface, double bottom_mm,
                              double top_mm);

}  // namespace lyr
