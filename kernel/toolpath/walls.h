// The walls of a layer: closed strands that follow its outline inwards, each beside the one before.
//
// Contract
//  1. The outermost wall's outer flank is the outline: its middle is half a width within, so that dimensions are exact.
//     Walls are spaced by width - overlap x height (1 - pi/4), at overlap 1 that of rounded rectangles without a gap
//     between. Lines stay lines, arcs are about the same centres in all walls.
//  2. With `thin_walls`, of the outermost, and `gap_fill`, of the others: where the region is so narrow that a wall's
//     opposite sides would lie over each other by more than a quarter of their spacing, there is no wall; that part is in
//     `thin` (no wall at all fits) or `gaps` (none beside the walls that do), as the region to be filled from flank to
//     flank. Thin parts narrower than `min_width_mm` and gaps narrower than `min_gap_mm` are left out and their area
//     counted; that of thin parts, where no wall is printed at all, once more by itself. So are the tips of corners of less
//     than 44 degrees, which a round line around them does not reach; of inner walls around what is not `solid`, 23 degrees.
//     Where they go over into walls there are joints, by which strands find the walls to end at. Where a web is too thin
//     for that, so that it joins nothing, is `lost_web`, the first such place.
//  3. `inside` is what the walls leave for fill: within the inner flanks of the innermost.
//  4. Of a count of 0 everything is inside.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/toolpath/joint.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/strand.h"

namespace lyr {

struct WallRequest {
    std::uint32_t count = 2;
    double width_mm = 0.45, height_mm = 0.2;
    double overlap = 1;                           // see 1; in [0, 1]
    double min_width_mm = 0.2, min_gap_mm = 0.1;  // of thin parts and gaps that are filled
    bool thin_walls = true, gap_fill = true;
    bool solid = true;  // what is inside will be filled; see 2
    Corner corner = Corner::round;
    double allowed_mm = 0;
};

struct Walls {
    std::vector<Strand> strands{};        // closed, the outermost first
    std::vector<std::uint32_t> depths{};  // by strand; 0: outermost
    std::vector<Contour> inside{};
    std::vector<Joint> thin_joints{}, gap_joints{};
    std::vector<Contour> thin{}, gaps{};
    std::optional<Point2> lost_web{};
    double left_out_mm2 = 0,
           too_thin_mm2 = 0;  // without `thin_walls`, of all that no wall fits into
    std::size_t second_method = 0, unresolved = 0;  // of the offsets and region operations
};

// `outline` as those of a section or of united(): material on the left, winding around no point more than once.
Walls walls(Region outline, const WallRequest& request);

}  // namespace lyr
