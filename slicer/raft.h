// A raft: layers of its own under the part, which is raised by them and by a gap of air.
//
// Contract
//  1. A raft reaches out beside the part's first layer and its support by 3 mm, across gaps of as much. It has
//     adhesion.raft_layers. The two on top, or the only one, are dense, those below half full; of more than one the first
//     is thick, all others as thick as the part's. Lines of each lie across those of the layer below, within one wall.
//  2. Over it is adhesion.raft_gap of air. The part's layers follow with layer.height, the first too: layer.first_height,
//     first_layer speeds, temperatures and fan are those of what is printed first, the raft.
//  3. Without a raft, nothing is raised and the part has its first layer.

#pragma once

#include <vector>

#include "slicer/fill.h"

namespace lyr::slicer {

// How many layers of the print are the raft's.
std::size_t raft_layers(const profile::Profile& profile);

// How far a raft reaches out beside what stands on it; 0: there is none.
double raft_reach_mm(const profile::Profile& profile);

// How far the part is raised over the bed.
double raised_mm(const profile::Profile& profile);

// All layers of a print over the bed: the raft's, and those of a part on the bed raised by as much.
std::vector<LayerSpan> on_raft(std::vector<LayerSpan> part, const profile::Profile& profile);

// The layers that a part on a raft has: its first one is like the others.
profile::Layer part_layers(const profile::Profile& profile);

// `footprint`: what is to stand on the raft.
std::vector<Piece> raft_pieces(std::size_t layer, Region footprint, const Options& options,
                               std::size_t& unresolved);

}  // namespace lyr::slicer
