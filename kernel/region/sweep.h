// A horizontal line goes up over an arrangement and keeps the edges it meets in their order from left to right. From
// the order follow the windings on both sides of every edge, and from them which edges bound the result.
//
// Contract
//  1. The order is only changed at vertices: edges that end there leave one place, and those that start there take it.
//     Whatever was computed wrong, the windings left and right of that place agree, so that the boundary closes.
//  2. An edge that lies between two that end in one vertex is led through this vertex; `worst_detour_mm` is the
//     farthest that one was led.
//  3. Neighbours whose upper ends say that their order is another than it was below cross each other unknown to the
//     arrangement: a contradiction. Where they do is given back in `crossings`, for an arrangement that has these
//     vertices too. As long as there are contradictions, the boundary is closed but not right.
//  4. Kept edges run with the inside on their left. `next` leads around the inside: where boundaries touch in a vertex,
//     each piece of the inside there keeps its own two edges.

#pragma once

#include <functional>

#include "kernel/region/arrangement.h"

namespace lyr::region {

using Inside = std::function<bool(const Winding&)>;

struct SweptEdge : Edge {
    Winding left{}, right{};
    bool kept = false;
    bool rises = false;         // the boundary runs from low to high
    std::uint32_t next = none;  // of the boundary, for a kept edge
};

struct Sweep {
    std::vector<SweptEdge> edges;
    std::size_t contradictions = 0;
    std::vector<Contact> crossings;
    double worst_detour_mm = 0;
};

Sweep swept(const Arrangement& arrangement, const Inside& inside, double snap_mm);

}  // namespace lyr::region
