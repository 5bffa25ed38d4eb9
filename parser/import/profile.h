// How much of a curve is swept: the geometry of contract 2 and 3 of swept.h.

#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "kernel/geometry/curve.h"

namespace lyr::importer {

struct Stretch {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void include(double t) {
        low = std::min(low, t);
        high = std::max(high, t);
    }
    // Samples of a boundary may miss its farthest point by a little.
    Stretch widened() const {
        const double margin = (high - low) / 16;
        return {low - margin, high + margin};
    }
};

// A whole turn, or a B-spline's domain. Not for curves without ends.
Stretch whole_stretch(const Curve& curve);

// Whether curve and axis (the frame's z) lie in one plane, to within resolution_mm.
bool is_coplanar(const Curve& curve, const Frame& axis);

// The parameters of a curve to be turned about an axis so that it covers the points: of a curve in a plane with the
// axis, a stretch that does not cross it; where two stretches serve as well, the one with `hint`. Nothing for a curve
// without ends, other than a line, that lies in no plane with the axis, or if there are no points to cover.
std::optional<Stretch> turned_stretch(const Curve& curve, const Frame& axis,
                                      const std::vector<Point3>& points,
                                      const std::optional<Point3>& hint);

}  // namespace lyr::importer
