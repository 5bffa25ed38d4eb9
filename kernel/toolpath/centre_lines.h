// Strands along the middle of narrow regions, as wide as these are: thin walls, and gaps between walls.
//
// The region is as in kernel/region: material on the left, winding around no point more than once.
//
// Contract
//  1. A strand's middle is that of the largest discs that fit into the region, within `allowed_mm`; its width is
//     theirs. It sticks out by no more than that and half of `width_step_mm`.
//  2. Where the width changes by more than `width_step_mm`, the strand has a width for each segment, which is the mean.
//     The width of a rib with parallel sides is constant, and its strand one line; that of concentric arcs is one arc
//     about their centre, and of two full circles a full circle.
//  3. Strands end half their width before the region does, or, at a joint, where the wall's covering does: a flat end
//     would reach a little into the wall, a round one overlaps it by half its width besides. Where three ribs meet, a
//     strand runs through two of them and the third one's ends beside it. Corners are filled as far as the strand's own
//     discs reach.
//  4. What is narrower than `min_width_mm` is left out, and what is too short for a strand; `left_out_mm2` has its
//     area. Where the region is wider than `max_width_mm`, the strand is that wide, and `beside_mm2` is what it
//     leaves; `corners_mm2` is what strands with round ends do not reach besides.
//  5. A part that is no longer than wide gets a short strand, half as wide as the part but no less than the least
//     width, if that is not too short.
//  6. `unresolved` counts regions that nothing could be made of in full: numbers that are not finite or out of range,
//     or contours that wind around a point more than once.
//  7. `broken` is a place where strands that follow each other, or one and what is covered at a joint, are farther apart
//     than the least width, because what is between them is narrower.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/joint.h"
#include "kernel/toolpath/strand.h"

namespace lyr {

// An extruder does not follow a finer change.
inline constexpr double width_step_mm = 0.02;

struct CentreLineRequest {
    double min_width_mm = 0.2, max_width_mm = 0.9;
    double allowed_mm = 0;
};

struct CentreLines {
    std::vector<Strand> strands{};
    double left_out_mm2 = 0, beside_mm2 = 0, corners_mm2 = 0;
    std::optional<Point2> broken{};  // see 7
    std::size_t unresolved = 0;
};

// The joints are those of walls(); parts of the region that none is at are as without.
CentreLines centre_lines(Region narrow, const CentreLineRequest& request,
                         std::span<const Joint> joints = {});

}  // namespace lyr
