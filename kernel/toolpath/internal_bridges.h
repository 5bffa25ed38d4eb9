// What of a layer's solid fill and top skin lies on what the layer below leaves sparse or empty: bridges inside the part.
//
// Contract
//  1. Moved from solid and top to internal_bridge is where a disc of `internal_bridge_widths` lines' widths fits into
//     what of them lies on sparse fill, and, as an anchor, what of them is within one width of that. What is narrower
//     stays as it is.
//  2. Parts that this leaves of solid and top, but narrower than a line, taken over their length, are moved too.
//  3. The parts are then as in contract 1 of skins.h, and together what they were.
//  4. Where an operation on regions could not be settled, all stays as it was, and is counted as unresolved.
//
// Cost: rows (row_cover.h), and for layers where these find room for one, overlays of the parts.

#pragma once

#include "kernel/toolpath/skins.h"

namespace lyr {

inline constexpr double internal_bridge_widths = 3;

// `sparse_below`: of the next layer below, as skins_of() left it.
void add_internal_bridges(LayerSkins& skins, Region sparse_below, const SkinRequest& request);

}  // namespace lyr
