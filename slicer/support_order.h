// The sequence of a layer's support, which is printed before the part.
//
// Contract
//  1. Every piece is printed once, from either end.
//  2. The empty head goes around the part where that is no farther than a detour is worth (detour.h), and draws back on
//     every way: what drips in the air would lie on the next layer.

#pragma once

#include <span>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/layer_order.h"

namespace lyr::slicer {

// `part`: the layer's outline, which the head keeps out of; empty: every way is straight.
std::vector<PrintMove> support_order(std::span<const OpenPiece> pieces, Region part,
                                     double allowed_mm);

// Where the head is when they have been printed; at the origin if there are none.
Point2 head_after(std::span<const PrintMove> moves, std::span<const OpenPiece> pieces);

}  // namespace lyr::slicer
