// How much lies beside a boundary.

#pragma once

#include "kernel/toolpath/boundary.h"

namespace lyr {

// The sum of the strips within the distance of each segment (positive: outwards), up to the centre of an arc that turns to
// that side, and of the sectors around the corners between them, or of the kites that mitres fill as far as `mitred_mm` from
// their corners. Where no two of them overlap, that is what an offset adds or takes away; else it is more.
double strip_mm2(const Boundary& boundary, double distance_mm, double mitred_mm);

}  // namespace lyr
