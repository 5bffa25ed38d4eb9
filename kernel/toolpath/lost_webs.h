// Webs that are too thin for a strand: what they join is printed apart.
//
// Contract: gives a place in a part of `rest` (what walls leave of the outline) that is not in `narrow` (what strands fill of
// it) and has the outline on two sides, so that it cuts walls or strands off each other. None where all such parts are
// filled. Notches, which have the outline on one side, and islands are none.
//
// Cost: n log n for the rest; a region operation only where a part may be such a web.

#pragma once

#include <cstddef>
#include <optional>

#include "kernel/toolpath/boundary.h"

namespace lyr {

// How often the part's boundary goes over from something else to the outline: twice or more in a web or a neck, once in a tip.
std::size_t sides_on(Region part, const Boundary& outline, double allowed_mm);

struct WebRequest {
    double min_width_mm, allowed_mm;  // nothing in `narrow` is narrower
};

std::optional<Point2> lost_web(Region rest, Region narrow, const Boundary& outline,
                               const WebRequest& request);

}  // namespace lyr
