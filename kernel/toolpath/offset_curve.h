// The curve that an offset's boundary is part of: beside each segment its parallel, and at each corner what joins them.
//
// Contract
//  1. The curves of a region wind around every point as often as the region does, less (inwards) or more (outwards) a
//     number that is
//       positive where the nearest point of the region's boundary is nearer than the distance,
//       zero where no point of it is, apart from what mitres add,
//       never negative within the distance.
//     So where they wind a positive number of times is the offset. docs/algorithms/offset.md says why.
//  2. A parallel is about the centre of its arc. An arc that turns towards the offset's side with no more than the
//     distance as radius has none: the curve goes to its centre and on from there.
//  3. Contours of which nothing is left are left out.

#pragma once

#include <optional>
#include <vector>

#include "kernel/toolpath/offset.h"

namespace lyr {

// A corner that turns back by nearly half a turn is gone round, whatever its sign says: to cover too much within the
// distance does no harm, and round-off decides the sign where two arcs meet in a cusp.
inline constexpr double cusp_rad = 1e-3;

std::vector<Contour> offset_curves(Region region, const OffsetRequest& request);

// The same curves with each corner's loop cut off where the parallels beside it cross: as long as nothing else crosses,
// the offset's boundary as it is. None if fewer than two
// sides of a contour keep a parallel, or more than two distances of them in a row keep none.
std::optional<std::vector<Contour>> trimmed_curves(Region region, const OffsetRequest& request);

}  // namespace lyr
