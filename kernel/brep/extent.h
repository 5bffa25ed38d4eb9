// Does a model lie where coordinates can be told apart, and are its edges where their vertices are?

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// A kilometre. Up to here doubles are a thousand times finer than resolution_mm, so that round-off does not add up to it.
inline constexpr double largest_coordinate_mm = 1e6;

// The errors have status geometry and the #id of the vertex, edge or face; in practice a coordinate or radius is damaged, or
// the unit is wrong.

// A point, an end of the edge or a control point beyond the largest coordinate, or what is no number.
Status check_extent(const Vertex& vertex);
Status check_extent(const Edge& edge);
Status check_extent(const Face& face);

// A vertex beyond, or an edge that ends farther from one of its vertices than the model's vertices, or the ends of its own
// curve, are apart.
Status check_places(const Model& model);

}  // namespace lyr
