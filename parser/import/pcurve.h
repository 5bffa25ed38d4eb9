// PCURVE, where it is the only thing that is said of an edge's curve: a curve in the parameters of a surface.
//
// Contract
//  1. Exact: any curve on a plane; lines along one parameter of cylinders, cones, spheres, tori and B-spline surfaces.
//  2. Other B-splines, polylines, circles and ellipses become cubic splines that are off by less than a quarter of
//     resolution_mm.
//  3. Anything else (a helix as a sloped line, which has no ends here; surfaces whose parameters are not those of the
//     standard) is an error, status unsupported.

#pragma once

#include "parser/import/curves.h"

namespace lyr::importer {

Result<DirectedCurve> read_pcurve(const File& file, InstanceIndex instance, const Units& units,
                                  part21::Trail& trail);

}  // namespace lyr::importer
