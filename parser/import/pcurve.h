// PCURVE, where it is the only thing that is said of an edge's curve: a curve in the parameters of a surface.
//
// Contract
//  1. Exact: any curve on a plane, and lines along one parameter of other surfaces (curve_on_surface.h).
//  2. Any other curve on any surface becomes a spline that is off by less than a quarter of resolution_mm. One without
//     ends, such as a helix, which is a sloped line, reaches from one end of the edge to the other, or as far as it is
//     trimmed; without either it is an error, status unsupported.
//  3. On a trimmed surface, whose parameters systems begin at its corner or count as its basis does, those are meant
//     that lead to the edge's ends.

#pragma once

#include "parser/import/curves.h"

namespace lyr::importer {

Result<DirectedCurve> read_pcurve(const File& file, InstanceIndex instance, const Units& units,
                                  part21::Trail& trail, const std::optional<Ends>& ends);

}  // namespace lyr::importer
