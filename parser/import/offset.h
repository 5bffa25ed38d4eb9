// OFFSET_SURFACE and OFFSET_CURVE_3D.
//
// Contract
//  1. Surfaces go along their normal as the file gives it: planes, cylinders, cones, spheres and tori become such again,
//     free-form ones B-splines (bspline_offset.h). Offsets of offsets add up.
//  2. What is offset by so much that nothing of it is left (a cylinder to its axis), or that it folds, is an error, status
//     geometry for the latter; an offset with a gap, at a crease wider than the file's uncertainty, too.

#pragma once

#include "parser/import/curves.h"
#include "parser/import/surfaces.h"

namespace lyr::importer {

// Down to what is no offset itself.
struct StatedOffset {
    InstanceIndex basis;
    double distance_mm;
};
Result<StatedOffset> read_stated_offset(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail);

Result<StatedSurface> read_offset(const File& file, InstanceIndex instance, const Units& units,
                                  const Boundary& boundary, part21::Trail& trail);

Result<DirectedCurve> read_offset_curve(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail);

}  // namespace lyr::importer
