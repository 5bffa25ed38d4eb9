// Area and flux of a face on a cylinder, a cone, a sphere or a torus, from points along its loops.
//
// Contract
//  1. `area` is the face's, `flux` the integral of (p - c) . n over it, n its outward normal, as exact as the nodes are.
//  2. On a surface that closes upon itself a boundary does not say which of two regions it bounds: `whole` is its area,
//     else 0, and `area` lies between.
//  3. Planes and B-splines are not asked about here.

#pragma once

#include <vector>

#include "kernel/geometry/surface.h"

namespace lyr {

// A point of a loop with the step of the integral there; at the vertices, without a step.
struct Node {
    Point3 point;
    Vector3 step;
};

using LoopNodes = std::vector<Node>;
using FaceNodes = std::vector<LoopNodes>;

// A face's area, and three times its part of the volume. `whole` is the area of a surface that closes upon itself.
struct FaceIntegrals {
    double area = 0, flux = 0, whole = 0;
};

// `sense`: 1 if the surface's normal is the face's, else -1.
FaceIntegrals elementary_integrals(const Surface& surface, const FaceNodes& nodes, double sense,
                                   const Point3& c);

}  // namespace lyr
