// The medial axis as long lines: without the branches that run into corners, and joined where branches meet.
//
// Contract
//  1. A branch is left out if its discs stick out of the one where it branches off by less than that one's radius; what
//     is narrower than the least width does not count. One that branches off where it is `covered` stays: how large
//     discs are there says nothing about it.
//  2. Where three or more branches meet, the two that are most nearly in line are one chain; the others end there.
//  3. Every edge that is not left out is in one chain, once. Chains are in the order of the edges.

#pragma once

#include <vector>

#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/medial_axis.h"

namespace lyr {

struct MedialChain {
    std::vector<MedialEdge> edges{};  // each ends where the next one starts
    bool is_closed = false;
    bool starts_at_branch = false, ends_at_branch = false;  // of another chain
};

std::vector<MedialChain> medial_chains(const MedialAxis& axis, double min_width_mm,
                                       const Boundary* covered = nullptr);

}  // namespace lyr
