// Where narrow parts of a region go over into walls, which the strands that fill them are to end at.
//
// Contract
//  1. `around` is the narrow parts and what they are cut off from, as far as it has a say in where their middle runs.
//  2. `covered` is what the walls cover, up to where strands are to end, a tenth of the walls' width within their flanks.
//     Outer corners are round there, as beads are.

#pragma once

#include <vector>

#include "kernel/contour/contour.h"

namespace lyr {

struct Joint {
    std::vector<Contour> around{}, covered{};
};

}  // namespace lyr
