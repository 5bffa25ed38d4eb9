// The flat parts (flatness.h) of faces that have no closed form by height alone.

#pragma once

#include <vector>

#include "kernel/section/flatness.h"

namespace lyr {

// Of a face on a cylinder, cone, torus or free-form surface. `heights`: those of its edges, of its apex and where it is
// level on a closed form.
std::vector<FlatPart> flat_cells(const Model& model, FaceId face,
                                 const std::vector<double>& vertex_level_mm, HeightRange heights,
                                 const FlatnessLimits& limits);

}  // namespace lyr
