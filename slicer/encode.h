// The third pass over a layer: its walls and fill, in the order in which they are printed, as bytes.

#pragma once

#include <span>

#include "format/writer.h"
#include "kernel/toolpath/seam.h"
#include "slicer/fill.h"

namespace lyr::slicer {

// What the encoding of a layer asks for. `seams` are those of the outermost walls; none: next to the head.
struct LayerToEncode {
    std::size_t index = 0;
    LayerSpan span;
    const OutlinedLayer& outlined;
    const LayerFill& fill;
    std::span<const Seam> seams;
};

// The coarsest of 1, 2, 5, 10, ... nm up to 1 um whose rounding stays within its share of the tolerance.
format::Quantum quantum_for(const Tolerance& tolerance);

SeamChoice seam_choice(profile::Seam seam);

// Errors are internal: a number that the file cannot hold.
Result<format::EncodedLayer> encode_layer(const LayerToEncode& layer, const Options& options,
                                          format::Quantum quantum);

}  // namespace lyr::slicer
