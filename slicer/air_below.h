// What of a print without support nothing holds from below.
//
// Contract
//  1. An island of a layer that nothing of the layer below is under begins in mid-air. The first one is warned of, with
//     its solid, layer and place, and how many more there are.
//  2. What reaches further out over air than a few lines side by side carry, and is no bridge (bridges.h), hangs over: one
//     warning for the print, with the first place, the number of layers, and the area in the layer with most of it.
//  3. The lowest layer lies on the bed or the raft.
//  4. Where it cannot be worked out, there is one warning for the print, with the number of layers and the first one.

#pragma once

#include <span>

#include "kernel/section/cutter.h"
#include "slicer/outline.h"

namespace lyr::slicer {

// The layers below `first` are a raft's, without outlines. `cutter` is the model's.
void warn_of_air_below(std::span<const OutlinedLayer> layers, std::span<const LayerSpan> spans,
                       std::size_t first, const Model& model, const Cutter& cutter,
                       const Options& options, Diagnostics& diagnostics);

}  // namespace lyr::slicer
