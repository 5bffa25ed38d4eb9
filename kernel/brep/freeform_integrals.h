// Area and flux of a face on a B-spline surface.
//
// Contract
//  1. `area_mm2` is the face's area, `flux_mm3` the integral of (p - c) . n over it, n its outward normal, each within
//     freeform_accuracy of what the whole surface has. Edges may lie beside the surface: their feet on it count.
//  2. Both are of the region on the left of the loops about the outward normal, if there is such a region. Where loops
//     run the other way and leave none, both have the opposite sign.
//  3. Loops may wind around a surface that is closed, hold its poles (sides that are one point) or be missing there.

#pragma once

#include "kernel/brep/model.h"
#include "kernel/brep/quadrature.h"

namespace lyr {

// Three Gauss points on each of up to 32 panels along the edges and across the surface.
inline constexpr double freeform_accuracy = 1e-4;

struct FreeformIntegrals {
    double area_mm2, flux_mm3;
};

// Of a face on a B-spline surface, and on no other.
// Less than for_figures is less accurate than freeform_accuracy.
FreeformIntegrals freeform_integrals(const Model& model, const Face& face, const Point3& c,
                                     const Fineness& fineness = for_figures);

}  // namespace lyr
