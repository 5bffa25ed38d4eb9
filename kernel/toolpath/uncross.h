// Contours that cross themselves or each other in single points, taken apart there.
//
// It is quicker than the operations of kernel/region where crossings are few, and gives up where they are not plain.

#pragma once

#include <optional>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

// The boundary of what the contours wind around a positive number of times: contours that nothing crosses as they are,
// the others from crossing to crossing. None where the boundary comes so near to itself without crossing itself clearly,
// stretches of less than half a circle's turn aside (turns.h), or windings beside a contour could not be counted.
std::optional<std::vector<Contour>> uncrossed(const BoundedRegion& curves, double clear_mm);

}  // namespace lyr
