// Curves with two ends: what trims and composite curves say of them.

#pragma once

#include <optional>

#include "kernel/geometry/curve.h"
#include "parser/import/curves.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

// The stretch from one parameter to another, which may be smaller; of a closed curve, a whole turn at most.
struct BoundedCurve {
    Curve curve;
    double from, to;

    Point3 start() const { return evaluate(curve, from); }
    Point3 end() const { return evaluate(curve, to); }
};

// How long a step of one along a curve's parameter in the file is in the kernel's. None of a curve that stands for
// another one, with parameters of its own.
Result<std::optional<double>> parameter_scale(const File& file, InstanceIndex curve,
                                              const DirectedCurve& read, const Units& units);

// TRIMMED_CURVE, by its trimming parameters or points as its master representation prefers; whole B-splines,
// polylines, composite curves, circles and ellipses; curves on surfaces by their curve in space. A curve without ends
// is an error.
Result<BoundedCurve> read_bounded_curve(const File& file, InstanceIndex user, InstanceIndex curve,
                                        const Units& units, part21::Trail& trail);

// COMPOSITE_CURVE and its subtypes: the segments as one B-spline, of the highest of their degrees. Segments that do
// not meet to within resolution_mm or the file's uncertainty are an error.
bool is_composite(std::string_view type);
Result<BSplineCurve> read_composite(const File& file, InstanceIndex instance, const Units& units,
                                    part21::Trail& trail);

}  // namespace lyr::importer
