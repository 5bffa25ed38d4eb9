// Edges as pieces whose height only rises or only falls, made once for all planes.
//
// Contract
//  1. Every end of a piece has a level: a height shared by all ends that are closer than resolution_mm. A plane
//     is above or below a level, never in it: level <= h is below. So all that lies in one horizontal plane of
//     the model is on the same side of every cutting plane.
//  2. bottom_mm < top_mm. A plane at h meets a piece exactly once if bottom_mm <= h < top_mm, else never.
//  3. For every edge and plane, the number of met pieces is odd if and only if the edge's vertices lie on
//     different sides: crossings can be paired around every closed loop.
//  4. Stretches within one level have no pieces; they are never met.

#pragma once

#include <span>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

struct MonotonePiece {
    EdgeId edge;
    double t_bottom, t_top;
    double bottom_mm, top_mm;  // levels
    bool rising;               // the edge, from start to end, goes up here
    Point3 middle;             // the piece's point half-way between its ends' parameters
};

struct MonotoneEdges {
    std::vector<MonotonePiece> pieces;
    std::vector<double> vertex_level_mm;  // by VertexId
};

MonotoneEdges monotone_pieces(const Model& model);

}  // namespace lyr
