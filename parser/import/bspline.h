// B_SPLINE_CURVE and B_SPLINE_SURFACE in their forms: with knots, uniform, quasi-uniform, Bezier, each rational or not.

#pragma once

#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/curve.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

bool is_bspline_curve(const File& file, InstanceIndex instance);
bool is_bspline_surface(const File& file, InstanceIndex instance);

Result<BSplineCurve> read_bspline_curve(const File& file, InstanceIndex instance,
                                        const Units& units);

// POLYLINE: a B-spline of degree 1.
Result<BSplineCurve> read_polyline(const File& file, InstanceIndex instance, const Units& units);

Result<BSplineSurface> read_bspline_surface(const File& file, InstanceIndex instance,
                                            const Units& units);

}  // namespace lyr::importer
