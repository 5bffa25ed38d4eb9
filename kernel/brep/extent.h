// Does a model lie where coordinates can be told apart?

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// A kilometre. Up to here doubles are a thousand times finer than resolution_mm, so that round-off does not add up to it.
inline constexpr double largest_coordinate_mm = 1e6;

// The error (status geometry) is the first vertex or control point beyond it, with the #id of its edge or face: in practice
// a damaged coordinate or a wrong unit.
Status check_extent(const Model& model);

}  // namespace lyr
