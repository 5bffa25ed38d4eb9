// The outline of a layer from its outermost walls. Private to this room.

#pragma once

#include <vector>

#include "format/export/polylines.h"

namespace lyr::format {

// Closed polygons, in mm and to `digit_mm`: outer ones counter-clockwise, holes clockwise. `walls` are closed; which of
// them are holes follows from what lies within what.
std::vector<std::vector<PlanePoint>> outline_of(std::vector<Polyline> walls, double digit_mm);

}  // namespace lyr::format
