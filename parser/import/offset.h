// OFFSET_SURFACE and OFFSET_CURVE_3D, where what they amount to is an elementary surface or curve again.
//
// Contract
//  1. Surfaces: planes, cylinders, cones, spheres, tori, along their normal as the file gives it. Curves: lines, and
//     circles whose plane is square to the reference direction. Anything else is an error, status unsupported.
//  2. What is offset by so much that nothing of it is left (a cylinder to its axis) is an error.

#pragma once

#include "parser/import/curves.h"
#include "parser/import/surfaces.h"

namespace lyr::importer {

Result<StatedSurface> read_offset(const File& file, InstanceIndex instance, const Units& units,
                                  const Boundary& boundary, part21::Trail& trail);

Result<DirectedCurve> read_offset_curve(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail);

}  // namespace lyr::importer
