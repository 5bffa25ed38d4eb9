// Level faces as regions: what lies under a flat underside, by the edges of the face.
//
// Contract
//  1. The region is bounded by the face's edges as seen from above, lines as lines and everything else as arcs within the
//     tolerance; its material is on the left, whichever way the face looks.
//  2. A face is level if it is a plane within lean_resolution_rad (leaning.h) of level.

#pragma once

#include <optional>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/contour/contour.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

struct LevelFace {
    double z_mm;
    bool looks_down;
    std::vector<Contour> region;
};

std::optional<LevelFace> level_face(const Model& model, FaceId id, const Tolerance& tolerance);

}  // namespace lyr
