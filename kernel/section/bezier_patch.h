// Values of one rational Bezier patch, for tracking: fast, without range checks.
//
// Contract
//  1. Parameters are global; those outside the patch continue its polynomials.
//  2. The quartic part is a bound, from fourth differences of the control points.
//  3. IsoLine is the height along a parameter line of the patch.

#pragma once

#include <array>
#include <utility>

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

Partials partials(const BezierPatch& patch, const Point2& uv);

// How far parameter lines over the whole width of the patch are from the cubics (of a rational patch, the quotients of
// cubics) with the same ends and derivatives there, at most; over a share of the width by the fourth power of the share less.
struct QuarticPart {
    double along_u_mm = 0, along_v_mm = 0;
};
QuarticPart quartic_part(const BezierPatch& patch);

class IsoLine {
public:
    // Along u at v = fixed, or along v at u = fixed.
    IsoLine(const BezierPatch& patch, bool along_u, double fixed);

    // The parameter between two bounds at which the level is crossed, within resolution_mm / 100 of it in height;
    // `above_at_start` is the sign at `start`, `guess` where the search begins.
    double crossing(double level_mm, double start, double end, bool above_at_start,
                    double guess) const;

    // Appends the parameters inside (start, end) where the height turns by more than flat_cell_mm.
    void append_turns(double start, double end, std::vector<double>& turns) const;

private:
    using Coefficients = std::array<double, highest_surface_degree + 1>;

    std::pair<double, double> value_and_slope(const Coefficients& scaled, double t) const;

    int degree_;
    double from_, width_;
    Coefficients z_, w_;
};

}  // namespace lyr
