// OFFSET_SURFACE and OFFSET_CURVE_3D.
//
// Contract
//  1. Surfaces go along their normal as the file gives it: planes, cylinders, cones, spheres and tori become such
//     again, free-form ones B-splines (bspline_offset.h). Offsets of offsets add up.
//  2. Curves go along the reference direction x their tangent: lines, and circles square to it, become such again, all
//     others a B-spline off by less than a quarter of resolution_mm. Of one without ends (a parabola) it is as long as
//     the edge needs; without an edge that is an error, status unsupported.
//  3. What is offset by so much that nothing of it is left (a cylinder to its axis), or that it folds, is an error,
//     status geometry for the latter; an offset with a gap, at a crease or corner wider than the file's uncertainty,
//     too.

#pragma once

#include "kernel/geometry/bspline_offset.h"
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

Diagnostic offset_failed(const File& file, InstanceIndex instance, InstanceIndex basis,
                         OffsetFailure failure);

Result<StatedSurface> read_offset(const File& file, InstanceIndex instance, const Units& units,
                                  const Boundary& boundary, part21::Trail& trail);

Result<DirectedCurve> read_offset_curve(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail,
                                        const std::optional<Ends>& ends);

}  // namespace lyr::importer
