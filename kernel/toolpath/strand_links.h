// Strands that end on a region's boundary, linked along it to few.
//
// Contract
//  1. Two ends are linked only if nothing else ends on the boundary between them, so no stretch of it is used twice; and
//     only if that stretch is no longer than the limit.
//  2. No strand is linked to itself. Every strand is in the result just once, forwards or backwards.
//  3. A link runs along the boundary, as its lines and arcs.

#pragma once

#include <span>
#include <vector>

#include "kernel/toolpath/boundary_ruler.h"

namespace lyr {

struct OpenStrand {
    BoundaryPlace start, end;
    std::vector<Segment> way;  // from start.point to end.point
};

std::vector<Path> linked(std::span<const BoundaryPiece> boundary,
                         std::span<const OpenStrand> strands, double longest_link_mm);

}  // namespace lyr
