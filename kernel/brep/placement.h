// Moves a model to where it is printed.
//
// Contract
//  1. transformed() moves every vertex, curve and surface; parameters stay those of contract 2 of model.h.
//  2. turned_up(up) is the shortest rotation that brings `up` to +z.
//  3. A mirroring keeps contract 1 of model.h: loops are reversed.

#pragma once

#include "kernel/brep/model.h"

namespace lyr {

Model transformed(Model model, const Eigen::Affine3d& transform);

Eigen::Affine3d turned_up(const Vector3& up);

}  // namespace lyr
