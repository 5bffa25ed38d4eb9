// A smooth plane curve as tangent-continuous arcs.
//
// Contract
//  1. The arcs start at `start` and end at `end`, exactly. Where they meet inside, they share the tangent; the
//     first leaves and the last arrives along the curve's own tangent.
//  2. No point of the curve is farther than `allowed_mm` from the arcs: they are held to points of it so dense that
//     nothing happens between them (see fit.cpp).
//  3. They are nearly as few as can be: docs/algorithms/arcs.md has the counts.
//  4. The same holds for a curve given by points, densely enough that its chords are a curve to the caller: every
//     point is within `allowed_mm`, between two neighbours the arcs stray no farther from their chord than the
//     curve does. A point that is there twice, with two tangents, is a corner; the arcs have it too. A stretch that is
//     straight comes out as a line.

#pragma once

#include <functional>
#include <span>
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

// From the first of the points to the last.
void fit_arcs(std::span<const CurvePoint> points, double allowed_mm, std::vector<Segment>& out);

}  // namespace lyr
