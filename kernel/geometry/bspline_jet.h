// What the functions on B-spline surfaces share: second derivatives and single Bezier patches.

#pragma once

#include "kernel/geometry/bspline_surface.h"

namespace lyr {

struct SurfaceJet {
    Point3 point;
    Vector3 du, dv, duu, duv, dvv;
};

// A rectangle of the domain.
struct Window {
    Point2 low, high;

    Point2 clamped(const Point2& uv) const { return uv.cwiseMax(low).cwiseMin(high); }
};

// The largest window about these parameters (in the domain) that has no kinks inside.
Window smooth_window(const BSplineSurface& surface, const Point2& uv);

// At parameters in the window, which begins and ends at knots or between two. At knots, where derivatives may jump,
// those of the span that begins there; at the window's end of the one that ends there.
SurfaceJet second_partials(const BSplineSurface& surface, const Point2& uv, const Window& window);

// The parameters inside the domain that stand for these.
Point2 into_domain(const BSplineSurface& surface, const Point2& uv);

// The patch of the spans [knots_u[span_u], knots_u[span_u + 1]], likewise v, neither of them empty.
BezierPatch bezier_patch(const BSplineSurface& surface, std::size_t span_u, std::size_t span_v);

}  // namespace lyr
