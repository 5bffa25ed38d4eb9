// Walls that run over air: where they do, they are printed as bridges are.
//
// Contract
//  1. A wall is over air where its middle is more than half of its width beyond the outline of the layer below: then nothing
//     of it has anything under it.
//  2. Stretches are the wall, from where it begins to where it ends, in order; each is over air or not as a whole. One that is
//     shorter than the wall is wide goes with the one before. A wall that is all one is left as it is, a circle a circle.
//  3. Where the layer below could not be made wider, no wall of the layer is taken to be over air.

#pragma once

#include <optional>
#include <vector>

#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/strand.h"
#include "slicer/outline.h"

namespace lyr::slicer {

struct WallStretch {
    Strand strand;  // open, if there is more than one
    bool over_air = false;
};

class HeldWalls {
public:
    // Of walls of this width over a layer; none if no wall is over air.
    static std::optional<HeldWalls> of(const OutlinedLayer& layer, const OutlinedLayer& below,
                                       const Options& options);

    // `wall`: closed, as it is printed; `start`: where a circle begins.
    std::vector<WallStretch> stretches(const Strand& wall, const Point2& start) const;

private:
    explicit HeldWalls(Region held) : held_(held) {}

    Boundary held_;
};

}  // namespace lyr::slicer
