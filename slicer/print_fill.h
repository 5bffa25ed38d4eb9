// All of a layer of a print besides its walls: the raft, or the part's fill with its support and what is around it.

#pragma once

#include <span>

#include "slicer/fill.h"
#include "slicer/support.h"

namespace lyr::slicer {

// `index` and `layers` count the raft's layers too, which have empty outlines and no skins.
LayerFill print_fill(std::size_t index, const Walls& walls, const PartLayers& layers,
                     const SupportPlan& support, const Options& options);

}  // namespace lyr::slicer
