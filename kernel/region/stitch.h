// The kept edges of a sweep as contours.
//
// Contract
//  1. No contour passes a vertex twice: where boundaries touch, they are separate contours that touch.
//  2. A contour that is all of one input contour and nothing else is named, not built: the input is better.
//  3. Edges along one segment are one segment again; one that is whole has the segment's own numbers. What else lies
//     on one circle or line is joined within `join_mm` (simplified() of kernel/contour).
//  4. A built contour into which no disc of diameter `sliver_mm` fits is left out and counted.

#pragma once

#include "kernel/region/sweep.h"

namespace lyr::region {

struct WholeInput {
    std::uint32_t input;
    bool reversed;
};

struct Stitched {
    std::vector<WholeInput> whole;
    std::vector<Contour> built;
    std::size_t slivers = 0;
};

Stitched stitched(std::span<const Input> inputs, const Arrangement& arrangement, const Sweep& sweep,
                  double join_mm, double sliver_mm);

}  // namespace lyr::region
