// The offset of a B-spline surface along its normal, as a B-spline surface again.
//
// Contract
//  1. At the same parameters |offset(s, d)(u, v) - (s(u, v) + d n(u, v))| <= offset_accuracy_mm, n = normal(s): proved
//     on every patch, not sampled. It is of degree 7, or 1 along straight lines of a constant normal.
//  2. d/du x d/dv of the result does not vanish, except where that of `s` does on a side of the domain (a pole, where n
//     is the limit; a side shorter than resolution_mm is one); normal() of the result is on the side of n. What has
//     gone beyond all centres of curvature is a surface again; what has for a part only has edges of regression, and is
//     a failure.
//  3. Where the normal jumps, across a crease, the offset has a gap. One of up to `closable_mm` is closed, and the
//     patch beside it is off by up to twice that; a larger one is a failure.

#pragma once

#include <variant>

#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

// A quarter of what the model's own coordinates resolve: edges that lie on the exact offset lie on this one.
inline constexpr double offset_accuracy_mm = resolution_mm / 4;

enum class OffsetFailure {
    folded,   // distance beyond the radius of curvature in a part of the surface
    creased,  // the surface has a crease, the offset would have a gap
    unreachable,  // not to that accuracy, with as many patches as there may be: almost folded, or no normal
};

std::variant<BSplineSurface, OffsetFailure> offset(const BSplineSurface& surface,
                                                   double distance_mm,
                                                   double closable_mm = resolution_mm);

}  // namespace lyr
