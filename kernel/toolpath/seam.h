// Where a closed contour is started, and the contour that starts there: a nozzle that comes and goes leaves a mark.
//
// Contract
//  1. The seam is on the contour, and does not depend on where the contour started before.
//  2. A corner is what turns by more than corner_rad within about the width of a line: a rounding that an offset made of
//     a corner is one too. Corners hide a seam, most of all those that the material goes round (concave ones).
//       nearest  next to the head; at a corner, if one is nearly as near
//       rear     farthest in y; at a corner, if one is nearly as far; of several places the one that is least in x
//       sharp    at the sharpest corner, concave before convex; of several as sharp the one next to the seam below,
//                else the rear one. If there is none: as aligned, if there is a seam below, else rear
//       aligned  next to the seam below as nearest is to the head; if there is none: sharp
//  3. started_at() keeps the shape: the segments in their order, one of them in two parts if the seam is within it, both
//     parts of an arc on its circle. A full circle stays as it is: whoever prints it begins at the seam's point.
//
// The layer below is known by its seams alone, so layers are sliced in any order, and seams put in one pass afterwards.
// Cost: linear in the segments.

#pragma once

#include <span>

#include "kernel/toolpath/strand.h"

namespace lyr {

enum class SeamChoice { nearest, rear, aligned, sharp };

struct SeamRequest {
    SeamChoice choice = SeamChoice::aligned;
    double width_mm = 0;              // of the line: the scale of what is near, and of corners
    Point2 head = Point2::Zero();     // for nearest
    std::span<const Point2> below{};  // seams of the layer below; those beside the contour count
};

// A smaller turn shows a seam as much as a smooth wall does.
inline constexpr double corner_rad = 0.5;

struct Seam {
    Point2 point;
    std::size_t segment = 0;  // within it, or at its start
    double fraction = 0;      // of the segment's length, in [0, 1)
};

Seam seam_of(const Contour& contour, const SeamRequest& request);

Contour started_at(const Contour& contour, const Seam& seam);

// Its widths go with the segments.
Strand started_at(const Strand& closed, const Seam& seam);

}  // namespace lyr
