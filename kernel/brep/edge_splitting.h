// Free edges that meet several shorter ones are divided at the vertices of these, so that edges can be matched one to
// one.

#pragma once

#include <vector>

#include "kernel/brep/free_edges.h"

namespace lyr {

// How far sewing reaches. Edges of one solid sew with each other; those of surfaces (Shell::is_surface) with those of
// any other surface too.
bool may_meet(const Model& model, const FreeEdge& a, const FreeEdge& b);

// Divides each free edge at the vertices of others that lie on it within `reach_mm`, away from its ends, if others run
// along it from there to both sides. Pieces keep the curve and the source; they end in the other edge's vertex.
void split_free_edges(Model& model, const std::vector<FreeEdge>& free, double reach_mm);

}  // namespace lyr
