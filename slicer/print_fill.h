// All of a layer of a print besides its walls: the raft, or the part's fill with its support and what is around it.

#pragma once

#include <span>

#include "slicer/fill.h"
#include "slicer/support.h"

namespace lyr::slicer {

// `index` counts the raft's layers too, which have empty outlines. Those of all layers are in `outlines`.
LayerFill print_fill(std::size_t index, const LayerSpan& span, const Walls& walls,
                     std::span<const SkinOutline> outlines, const SupportPlan& support,
                     const Options& options);

}  // namespace lyr::slicer
