// The exact bounding box of a model.

#pragma once

#include "kernel/brep/model.h"
#include "kernel/geometry/tolerance.h"

namespace lyr::slicer {

// Corners are exact to resolution_mm for elementary surfaces.
Eigen::AlignedBox3d bounding_box(const Model& model, const Tolerance& tolerance,
                                 unsigned threads = 1);

}  // namespace lyr::slicer
