// Pairs of free edges that are one edge: their ends coincide and so does what is between them.
//
// Contract
//  1. Paired edges are nowhere farther apart than `reach_mm`, as several points along each tell; none is in two pairs.
//  2. Where several could be paired: those of the same shell before those of one solid, and these before those of
//     different surfaces; what is nearest by far before what is not; then those that join faces which hang
//     together already and agree.

#pragma once

#include <vector>

#include "kernel/brep/face_parity.h"
#include "kernel/brep/free_edges.h"

namespace lyr {

struct EdgePair {
    FreeEdge a, b;
    bool same_direction;  // of the edges, not of the faces' uses
    double gap_mm;
};

// `parity` learns of every pair.
std::vector<EdgePair> matching_edges(const Model& model, const std::vector<FreeEdge>& free,
                                     double reach_mm, FaceParity& parity);

}  // namespace lyr
