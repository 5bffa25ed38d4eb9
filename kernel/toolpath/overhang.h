// What of a layer hangs over air, and needs to be held from below.
//
// Contract
//  1. Held is to be what is within `margin_mm` of an edge that leans out (leaning.h says which do), and of every place of
//     the layer over air where a disc of `ledge_mm` fits between the layer below and the layer's outline: a flat underside
//     has no edge of its own. A ledge that is narrower is carried by the lines of the layer below.
//  2. Of flat undersides, those are left out that are bridges: with no leaning edge beside them, held at both ends of
//     every row in one direction, none of the rows longer than `longest_bridge_mm`.
//  3. Nothing is within `blocked`, nor within an edge's reach of blocked edges.
//  4. What an operation on regions could not settle is counted, and held.

#pragma once

#include <span>
#include <vector>

#include "kernel/region/region.h"

namespace lyr {

struct OverhangRequest {
    double ledge_mm = 0.45;
    double margin_mm = 1;
    double longest_bridge_mm = 10;
    double width_mm = 0.45;  // of a line
    double allowed_mm = 0;
};

// An open path, as a part of the layer's outline.
struct BlockedEdge {
    Path path;
    double reach_mm;  // how far its face leans out from it, over the layer's height
};

struct OverhangEdges {
    std::vector<Path> leaning{};  // of the layer's outline
    std::vector<BlockedEdge> blocked{};
    std::vector<Contour> blocked_area{};  // undersides by themselves
};

struct Overhang {
    std::vector<Contour> contours{};  // that support is to hold
    std::size_t unresolved = 0;
};

// `leaning_below`: of the layer below, as they tell flat undersides from slopes too. Whether there may be a flat underside is
// known to the caller (`RowCover` of both): if not, `layer` and `below` are not looked at.
Overhang overhang_of(Region layer, Region below, const OverhangEdges& edges,
                     std::span<const Path> leaning_below, bool may_be_flat,
                     const OverhangRequest& request);

// Everything within a distance of open paths.
std::vector<Contour> strokes(std::span<const Path> paths, double distance_mm, double allowed_mm,
                             std::size_t& unresolved);

}  // namespace lyr
