// The third pass over a layer: its walls and fill, in the order in which they are printed, as bytes.

#pragma once

#include <span>

#include "format/writer.h"
#include "kernel/toolpath/layer_order.h"
#include "slicer/fill.h"

namespace lyr::slicer {

// Of a part that is printed more than once.
struct Copy {
    std::uint32_t object = 0;         // its number in the file; 0: the part is the only one
    Vector2 shift = Vector2::Zero();  // from the first copy
};

// What the encoding of a layer asks for.
struct LayerToEncode {
    std::size_t index = 0;
    LayerSpan span;
    const OutlinedLayer& outlined;
    const OutlinedLayer* below;  // null: it lies on the bed or a raft
    const LayerFill& fill;
    std::span<const PrintMove> moves;
    std::span<const Copy> copies;    // printed one after the other
    std::span<const Piece> skirt{};  // around all of them, printed first
    bool begins_print = false;
    double lift_mm = 0;  // of the head, when all is done
};

// The coarsest of 1, 2, 5, 10, ... nm up to 1 um whose rounding stays within its share of the tolerance.
format::Quantum quantum_for(const Tolerance& tolerance);

SeamChoice seam_choice(profile::Seam seam);

// The sequence of a layer's walls and pieces. `seams` are those of the outermost walls; none: next to the head.
std::vector<PrintMove> order_layer(const OutlinedLayer& outlined, const LayerFill& fill,
                                   std::span<const Seam> seams, const Options& options);

// Errors are internal: a number that the file cannot hold.
Result<format::EncodedLayer> encode_layer(const LayerToEncode& layer, const Options& options,
                                          format::Quantum quantum);

}  // namespace lyr::slicer
