// Curves of ISO 10303-42 as the kernel's curves.
//
// Contract
//  1. LINE, CIRCLE, ELLIPSE, PARABOLA, HYPERBOLA, POLYLINE and B_SPLINE_CURVE in all its forms; curves on surfaces
//     (SURFACE_CURVE, SEAM_CURVE, INTERSECTION_CURVE) by their curve in space; TRIMMED_CURVE by its basis, for it
//     is the edge's vertices that trim; COMPOSITE_CURVE as one B-spline (bounded_curve.h); CURVE_REPLICA;
//     OFFSET_CURVE_3D (offset.h); PCURVE (pcurve.h). Anything else is an error, status unsupported.
//  2. same_sense is false when the curve as stated runs against the parameter of `curve`.
//  3. A B-spline's degree, knots, multiplicities, points and weights agree in number and range, or it is an error.

#pragma once

#include <optional>

#include "kernel/geometry/curve.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

struct DirectedCurve {
    Curve curve;
    bool same_sense = true;
};

// Where an edge begins and ends on its curve, and whether it runs along the curve as stated: for curves that have no
// ends of their own and no form but as far as they are needed. One point twice: once around.
struct Ends {
    Point3 start, end;
    bool same_sense;
};

Result<DirectedCurve> read_curve(const File& file, InstanceIndex user, InstanceIndex curve,
                                 const Units& units, part21::Trail& trail,
                                 const std::optional<Ends>& ends = std::nullopt);

// A B-spline that is one straight line as that line; any other curve as it is.
Curve simplified(const Curve& curve);

}  // namespace lyr::importer
