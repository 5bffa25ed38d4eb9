// Where faces are in height: their loops, and the points inside where a surface may be highest or lowest.

#pragma once

#include <vector>

#include "kernel/brep/model.h"
#include "kernel/brep/monotone.h"

namespace lyr {

struct HeightRange {
    double bottom_mm, top_mm;
};

// The exact heights of each face's loops, by face; of one without vertices the bottom is above the top.
std::vector<HeightRange> loop_heights(const Model& model, const MonotoneEdges& edges);

Point3 apex_of(const Cone& cone);

// Points where a closed surface is level, one on each connected set of them, and a spindle torus' poles.
std::vector<Point3> level_points(const Surface& surface);

}  // namespace lyr
