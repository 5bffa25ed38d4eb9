// Infill along the boundary: offsets of the region, each made of the region itself.
//
// The first lies where, with the strands' own width, lines would begin at the wall: at density 1 on the region's
// boundary. In the middle, what is narrower than two strands' spacing stays empty.

#pragma once

#include "kernel/toolpath/infill.h"

namespace lyr {

void fill_with_offsets(Region inside, const InfillRequest& request, Fill& fill);

}  // namespace lyr
