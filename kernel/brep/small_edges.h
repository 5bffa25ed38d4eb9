// Edges too short to be anything.

#pragma once

#include <cstddef>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

// Takes edges out of their loops, their two vertices becoming one. A loop that had no others goes with them, and a
// face that had no other loops.
void drop_edges(Model& model, const std::vector<EdgeId>& edges);

// Edges in use that are nowhere farther than `length_mm` from their start, as several points along them tell.
std::vector<EdgeId> edges_within(const Model& model, double length_mm);

}  // namespace lyr
