// SURFACE_OF_LINEAR_EXTRUSION and SURFACE_OF_REVOLUTION.
//
// Contract
//  1. What is an elementary surface becomes one: a line swept along or about anything but a skew axis, a circle moved
//     along its axis, a circle turned about an axis in its plane.
//  2. Everything else becomes a B-spline, exactly. It reaches along the sweep, and along curves without end, beyond
//     the boundary by a sixteenth of what the boundary spans; B-splines and closed curves are swept whole.
//  3. A curve in a plane with the axis that it crosses sweeps out points from both sides: only the part to one side,
//     where the boundary is, is turned.

#pragma once

#include "parser/import/surfaces.h"

namespace lyr::importer {

// What the file says: a point of the surface is one of the curve moved by v times the length along the direction, or
// turned by u about the axis (the frame's z).
struct StatedExtrusion {
    InstanceIndex swept;
    Vector3 direction;  // unit length
    double length_mm;
};
Result<StatedExtrusion> read_stated_extrusion(const File& file, InstanceIndex instance,
                                              const Units& units);

struct StatedRevolution {
    InstanceIndex swept;
    Frame axis;
};
Result<StatedRevolution> read_stated_revolution(const File& file, InstanceIndex instance,
                                                const Units& units);

Result<StatedSurface> read_extrusion(const File& file, InstanceIndex instance, const Units& units,
                                     const Boundary& boundary, part21::Trail& trail);

Result<StatedSurface> read_revolution(const File& file, InstanceIndex instance, const Units& units,
                                      const Boundary& boundary, part21::Trail& trail);

}  // namespace lyr::importer
