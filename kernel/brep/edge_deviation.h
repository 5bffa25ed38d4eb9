// Do edges lie on the surfaces of the faces that they bound?

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// A warning for each face of which an edge lies farther off the surface than `accepted_mm`, as a few points of each edge
// tell: with the edge's #id, the greatest distance and where that is.
void report_deviations(const Model& model, double accepted_mm, Diagnostics& diagnostics);

}  // namespace lyr
