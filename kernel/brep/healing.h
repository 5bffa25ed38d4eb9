// Repairs what files get wrong about topology, and says so.
//
// Contract
//  1. Healed: consecutive edges of a loop that end in different vertices at one place; edges without length; faces that
//     share no edges although they meet (sewing.h); loops that run the wrong way round, same_sense flags that
//     contradict them, faces and shells that look the wrong way. Within `accepted_mm` with notes, beyond it, up to
//     `limit_mm`, with warnings; what has no measure with notes. All have status geometry.
//  2. Each connected set of faces of surfaces (Shell::is_surface) becomes a solid of its own. If it closes it is the
//     boundary of its inside and no surface any more.
//  3. What is closed, has edges of some length and loops that hang together is not touched.
//  4. What remains open is not named here: see validity.h. Nor are edges off their surfaces: see edge_deviation.h.

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "kernel/brep/sewing.h"

namespace lyr {

void heal(Model& model, const SewingReach& reach, Diagnostics& diagnostics);

}  // namespace lyr
