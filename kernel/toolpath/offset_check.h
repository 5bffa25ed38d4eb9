// Whether a result is the offset that was asked for, by means that the methods which make it do not use.
//
// Contract: none is found only if
//  1. the ends and the middle of every segment of the result are as far from the region's boundary as the distance,
//     within the tolerance (where corners are mitred, up to the mitre's limit), and on the right side of it;
//  2. every contour has the material on its left: beside it, the others wind as often as they have to;
//  3. the area is within bounds that hold for every offset: the region's and what each segment and each corner can
//     cover, and the inequality of Brunn and Minkowski;
//  4. nothing is missing: beside some places of every segment, its middle among them, and at every corner the result has
//     a boundary at the distance, unless another part of the region's boundary is as near (or a mitre). So what is lost
//     unseen is smaller than the places are apart, some distances.
// What is found is the first that is wrong.

#pragma once

#include <optional>

#include "kernel/toolpath/offset.h"

namespace lyr {

std::optional<OffsetFault> fault_of(const BoundedRegion& result, const BoundedRegion& region,
                                    const OffsetRequest& request);

// What offset() makes of what its first method found: that, if nothing is wrong with it, else what the second finds.
OffsetResult settled(const RegionResult& first, const BoundedRegion& region,
                     const OffsetRequest& request);

}  // namespace lyr
