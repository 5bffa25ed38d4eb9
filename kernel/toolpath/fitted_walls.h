// Walls side by side that are made a little wider where they leave a gap too narrow for a line between them, and a little
// narrower where they overlap.
//
// Contract
//  1. Where two walls run side by side, opposite ways, and their middles are between `least_mm` and `greatest_mm` apart,
//     both are made wider or narrower by half of what these are farther than `spacing_mm` apart, and their middles moved by
//     a quarter of it: the outer flank stays where it is, and there is neither gap nor overlap between them.
//  2. Lines stay lines, arcs are about the same centres; where the width changes there is a step, which goes slanting, as
//     wide as what is narrower beside it.
//  3. What is farther from the other wall, or nearer, stays as it is; walls of which that is all are the same bit for bit.
//
// Cost: a look across every half a width of the walls.

#pragma once

#include <span>

#include "kernel/toolpath/strand.h"

namespace lyr {

struct FitRequest {
    double spacing_mm, least_mm, greatest_mm;
};

// Closed strands of one width, with the material on the left.
void fit_side_by_side(std::span<Strand> walls, const FitRequest& request);

}  // namespace lyr
