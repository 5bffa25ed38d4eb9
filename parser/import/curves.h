// Curves of ISO 10303-42 as the kernel's curves.
//
// Contract
//  1. LINE, CIRCLE, ELLIPSE, PARABOLA, HYPERBOLA, POLYLINE and B_SPLINE_CURVE in all its forms; curves on surfaces
//     (SURFACE_CURVE, SEAM_CURVE, INTERSECTION_CURVE) by their curve in space; TRIMMED_CURVE by its basis, for it
//     is the edge's vertices that trim; COMPOSITE_CURVE as one B-spline (bounded_curve.h); CURVE_REPLICA;
//     OFFSET_CURVE_3D of lines and circles (offset.h); PCURVE (pcurve.h). Anything else is an error, status
//     unsupported.
//  2. same_sense is false when the curve as stated runs against the parameter of `curve`.
//  3. A B-spline's degree, knots, multiplicities, points and weights agree in number and range, or it is an error.

#pragma once

#include "kernel/geometry/curve.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

struct DirectedCurve {
    Curve curve;
    bool same_sense = true;
};

Result<DirectedCurve> read_curve(const File& file, InstanceIndex user, InstanceIndex curve,
                                 const Units& units, part21::Trail& trail);

// A B-spline that is one straight line as that line; any other curve as it is.
Curve simplified(const Curve& curve);

}  // namespace lyr::importer
