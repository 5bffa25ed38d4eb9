// A smooth run of points as tangent-continuous arcs, nearly as few as can be.
//
// Contract
//  1. The arcs lead from the first point to the last. The first leaves along its tangent, the last arrives along its;
//     where arcs meet, they share the tangent. Only where the points turn so sharply that no arc is within the bound, a
//     chord goes on to the next.
//  2. Every point is within `bound_mm` of the arcs, and beside them: arcs do not leave out where the points go out and come
//     back. Between neighbours that are far apart, the cubic through them is.
//
// Two arcs at least. The points are at least two, no two neighbours the same.

#pragma once

#include <span>
#include <vector>

#include "kernel/contour/fit.h"

namespace lyr {

void chain_arcs(std::span<const CurvePoint> points, double bound_mm, std::vector<Segment>& out);

}  // namespace lyr
