// The second pass over a layer: everything within and beside its walls, with the role of each piece.

#pragma once

#include <optional>
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
    bool asks_sparse = false;      // there is room for sparse fill, and the profile asks for it
    bool is_unheld = false;        // solid fill lies on nothing: a bridge inside that no side holds
    double thin_left_out_mm2 = 0;  // of the thin parts, what no strand fits into
    std::optional<Point2> thin_broken{};  // where two of their strands are not joined for that
    std::size_t unresolved = 0;
};

// The part's layers from the bed upwards, without a raft: a layer's fill depends on those around it.
struct PartLayers {
    std::span<const LayerSpan> spans;
    std::span<const SkinOutline> outlines;
    std::span<const LayerSkins> skins;  // of skins_of_layer(), without bridges inside

    PartLayers from(std::size_t first) const {
        return {spans.subspan(first), outlines.subspan(first), skins.subspan(first)};
    }
};

LayerSkins skins_of_layer(std::size_t index, const Walls& walls,
                          std::span<const SkinOutline> outlines, const Options& options);
LayerFill fill_layer(std::size_t index, const Walls& walls, const PartLayers& layers,
                     const Options& options);

}  // namespace lyr::slicer
