// Sewing: faces that meet in space but share no edge get one.
//
// Contract
//  1. Free edges that coincide within `accepted_mm`, a whole edge with one or with a chain of shorter ones, become one
//     edge, their vertices one vertex; a note says how many. What then remains free is matched within `limit_mm`, each
//     such gap with a warning that names both edges and its width.
//  2. Edges of one solid are sewn with each other, those of surfaces (Shell::is_surface) with those of all others.
//  3. Nothing moves by more than the gap: a kept edge keeps its curve. What no free edge touches stays as it is.
//  4. The result does not depend on which way faces look or edges run. Faces are not turned over: see orientation.h.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

struct SewingReach {
    double accepted_mm;  // by the file's own statement the same
    double limit_mm;     // probably meant to be the same; not below accepted_mm
};

void sew(Model& model, const SewingReach& reach, Diagnostics& diagnostics);

}  // namespace lyr
