// Loops of a face on a B-spline surface in the surface's parameters, as nodes of integrals along them.
//
// Contract
//  1. Nodes lie on the coedges in order, as Gauss points of panels (quadrature.h). `uv` is the foot on the surface;
//     through a seam it is followed out of the domain, so that neighbours are always near.
//  2. From one node to the next, parameters jump only where the loop passes a pole: a side of the surface that is one
//     point.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/brep/quadrature.h"

namespace lyr {

// With the step of the integral there, in the parameters.
struct ParameterNode {
    Point2 uv;
    Vector2 step;
};

// Between the nodes before `next_node`, the last one before the first, and that.
struct PolePassage {
    std::size_t next_node;
    Point3 pole;
};

struct ParameterLoop {
    std::vector<ParameterNode> nodes;
    std::vector<PolePassage> passages;
};

// The point that the first or the last line of control points along u (or v) is, if it is one.
std::optional<Point3> pole_of(const BSplineSurface& surface, bool along_u, bool at_end);

// Of each parameter; 0: the surface is not closed that way.
Vector2 periods_of(const BSplineSurface& surface);

// The parameters that stand for `uv` and are nearest to `last`.
Point2 followed(Point2 uv, const Point2& last, const Vector2& period);

// Of each loop of the face; one of a vertex loop has no nodes.
std::vector<ParameterLoop> parameter_loops(const Model& model, const Face& face,
                                           const Fineness& fineness);

// How often a loop goes around in each parameter.
Eigen::Vector2i turns_of(const ParameterLoop& loop, const Vector2& period);

}  // namespace lyr
