// The second pass over a layer: everything within and beside its walls, with the role of each piece.

#pragma once

#include <span>
#include <variant>

#include "format/operation.h"
#include "kernel/toolpath/hatch_runs.h"
#include "slicer/outline.h"

namespace lyr::slicer {

// Printed in one go, from either end.
struct Piece {
    format::Role role;
    std::variant<Strand, HatchRun> way;
    double flow = 1;
};

// Links between rows too.
double length_mm(const Piece& piece);

struct LayerFill {
    std::vector<Piece> around{};  // closed, to be printed before everything else, in this order
    std::vector<Piece> pieces{};
    std::size_t support =
        0;  // so many of the pieces, the first ones: before the part, from support or raft
    std::size_t unresolved = 0;
};

// `outlines` are those of all layers.
LayerFill fill_layer(std::size_t index, const LayerSpan& span, const Walls& walls,
                     std::span<const SkinOutline> outlines, const Options& options);

}  // namespace lyr::slicer
