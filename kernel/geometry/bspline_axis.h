// A B-spline surface seen along one of its parameters.

#pragma once

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

struct Axis {
    int degree;
    std::size_t count;
    const std::vector<double>& knots;
    bool closed;

    double start() const { return knots[static_cast<std::size_t>(degree)]; }
    double end() const { return knots[count]; }
};

inline Axis axis_u(const BSplineSurface& s) {
    return {s.degree_u, s.count_u, s.knots_u, s.closed_u};
}
inline Axis axis_v(const BSplineSurface& s) {
    return {s.degree_v, s.count_v, s.knots_v, s.closed_v};
}

}  // namespace lyr
