// How near a boundary comes to itself.

#pragma once

#include "kernel/toolpath/boundary.h"

namespace lyr {

// About how much a disc of the width does not reach, of what is inside of the boundary, because of other pieces than those
// with which one is a stretch (turns.h): these make corners, up to a sharpness of 0.4 rad. Estimated from how long the boundary
// runs where such a disc that touches it meets another piece, in steps of a quarter of the width. Where the disc's ways end
// in tips, they are mitred: they go on to a point up to so many half widths away.
double narrow_mm2(const Boundary& boundary, double width_mm, double mitre_limit);

}  // namespace lyr
