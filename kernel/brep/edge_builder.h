// Edges from what a file states of them: a curve, two vertices and whether the edge runs along the curve.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// Finds the parameters of the end points on the curve. `same_sense` false: the edge runs against the curve's
// parameter. Start and end the same vertex on a closed curve: once around.
// Reports (as warnings, status geometry, with the edge's #id) vertices farther off the curve than
// `uncertainty_mm` or resolution_mm, whichever is larger.
Edge make_edge(const Curve& curve, VertexId start, VertexId end, bool same_sense, SourceId source,
               const Model& model, double uncertainty_mm, Diagnostics& diagnostics);

}  // namespace lyr
