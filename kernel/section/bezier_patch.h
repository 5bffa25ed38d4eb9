// Values of one rational Bezier patch, for tracking: fast, without range checks.
//
// Contract
//  1. Parameters are global; those outside the patch continue its polynomials.
//  2. IsoLine is the height above a level along a parameter line of the patch, as a polynomial times the (positive)
//     denominator: its sign is that of height - level, its zeros are the crossings.

#pragma once

#include <array>
#include <utility>

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

Partials partials(const BezierPatch& patch, const Point2& uv);

class IsoLine {
public:
    // Along u at v = fixed, or along v at u = fixed.
    IsoLine(const BezierPatch& patch, bool along_u, double fixed);

    // Sign of height - level, and its derivative by the parameter.
    std::pair<double, double> above(double level_mm, double parameter) const;

    // The parameter between two bounds at which the level is crossed; `above_at_start` is the sign at `start`.
    double crossing(double level_mm, double start, double end, bool above_at_start) const;

    // Appends the parameters inside (start, end) where the height turns by more than flat_cell_mm.
    void append_turns(double start, double end, std::vector<double>& turns) const;

private:
    int degree_;
    double from_, width_;
    std::array<double, highest_surface_degree + 1> z_, w_;
};

}  // namespace lyr
