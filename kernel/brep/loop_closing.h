// Loops whose edges do not end in each other's vertices.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "kernel/brep/sewing.h"

namespace lyr {

// Where an edge of a loop ends and the next one begins, the two vertices become one if they are at one place: within
// the accepted distance with a note in all, within the limit with a warning each. An edge that is a whole loop, on a
// closed curve, then goes once around. Whether anything has been changed.
bool close_loops(Model& model, const SewingReach& reach, Diagnostics& diagnostics);

}  // namespace lyr
