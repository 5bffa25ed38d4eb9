// A smooth plane curve as tangent-continuous arcs.
//
// Contract
//  1. The arcs start at `start` and end at `end`, exactly. Where they meet inside, they share the tangent; the
//     first leaves and the last arrives along the curve's own tangent.
//  2. No point of the curve is farther than `allowed_mm` from the arcs; the deviation's extrema are interpolated
//     between samples, not just sampled (see fit.cpp).
//  3. Arcs are as long as the bound allows, found by bisection.
//
// Method: biarcs with equal tangent lengths (Bolton, "Biarc curves", CAD 7(2), 1975), greedily.

#pragma once

#include <functional>
#include <vector>

#include "kernel/contour/arc.h"

namespace lyr {

struct CurvePoint {
    Point2 point;
    Vector2 tangent;  // unit, in the direction of rising parameter
};

using PlaneCurve = std::function<CurvePoint(double parameter)>;

void fit_arcs(const PlaneCurve& curve, double from, double to, const Point2& start,
              const Point2& end, double allowed_mm, std::vector<Segment>& out);

}  // namespace lyr
