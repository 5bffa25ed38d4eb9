// What of an open path of lines and arcs lies in a region, and what beside it. Arcs stay arcs.
//
// Contract
//  1. Crossings are in closed form. What lies between two of them is in the region or not as a whole, and its middle says
//     which: a crossing that is computed twice, or where the path only touches the boundary, does no harm.
//  2. Parts are in the path's order and direction. Where a part ends on the boundary, its end's place says where.
//  3. A part that runs along the boundary, within round-off, may be in the result or not.
//  4. cut_at() leaves nothing out: its path begins and ends where the given one does, bit for bit, and segments that cross no
//     boundary are the same bit for bit. What lies between crossings closer than resolution_mm is part of what follows.
//
// Cost: for each segment log n, and what is near.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/toolpath/boundary_ruler.h"

namespace lyr {

struct PathPart {
    Path path;
    std::optional<BoundaryPlace> start, end;  // none where the path itself begins or ends
};

// An open path does not have to end where it starts.
std::vector<PathPart> clipped(const Path& path, const Boundary& region);

// A path whose segments are in the region or not as a whole.
struct CutPath {
    Path path;
    std::vector<bool> inside{};           // by segment
    std::vector<std::uint32_t> origin{};  // by segment, the one of the given path that it is of
};

CutPath cut_at(const Path& path, const Boundary& region);

}  // namespace lyr
