// Is a model's topology what the section relies on?
//
// Contract
//  1. An empty answer means: every index is in range, consecutive coedges of a loop meet in a vertex, and within
//     each shell every edge has as many coedges along it as against it.
//  2. Everything else is named, with the #id of the loop or edge and its position; of a hole in a shell all edges and
//     the size.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// Warnings, not errors: whether a plane can still be cut shows when its contours close or do not.
Diagnostics validate(const Model& model);

// The shells with an edge that is not used once along and once against: they bound no volume.
std::vector<ShellId> open_shells(const Model& model);

}  // namespace lyr
