// What is printed around the part on the bed: a skirt, which starts the flow, or a brim, which holds the part down.

#pragma once

#include "slicer/fill.h"

namespace lyr::slicer {

// Closed strands, the outermost first. A brim's innermost line touches the outline's outer boundaries; holes have none.
// Offsets that could not be verified are counted in `unresolved`.
std::vector<Piece> adhesion_of(Region outline, double height_mm, const Options& options,
                               std::size_t& unresolved);

// How far skirt or brim reaches from the outline, its own width included; 0: there is none.
double adhesion_reach_mm(const profile::Profile& profile);

}  // namespace lyr::slicer
