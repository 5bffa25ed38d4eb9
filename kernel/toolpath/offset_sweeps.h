// The second method: what a disc of the distance covers on its way along the boundary, segment by segment, is taken
// away from the region or added to it.
//
// It knows nothing of corners, of sides and of the boundary's order: the sum of a curve and a disc is that of two discs
// at its ends and of a rectangle, or of a sector of a ring, beside it. So it is slow, and as sure as the operations of
// kernel/region are. The region may cross itself.

#pragma once

#include "kernel/toolpath/offset.h"

namespace lyr {

RegionResult offset_by_sweeps(Region region, const OffsetRequest& request);

}  // namespace lyr
