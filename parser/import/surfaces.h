// Surfaces of ISO 10303-42 as the kernel's surfaces.
//
// Contract
//  1. PLANE, CYLINDRICAL_, CONICAL_, SPHERICAL_, TOROIDAL_ and DEGENERATE_TOROIDAL_SURFACE; B_SPLINE_SURFACE in all its
//     forms; swept surfaces (swept.h); RECTANGULAR_TRIMMED_ and CURVE_BOUNDED_SURFACE by their basis, for it is the
//     face's loops that bound; SURFACE_REPLICA; OFFSET_SURFACE (offset.h). Anything else is an error, status
//     unsupported.
//  2. The kernel's cone opens along its axis from a radius >= 0: a negative semi-angle turns the axis around, a
//     negative radius moves the origin to the apex. A semi-angle of zero is a cylinder.
//  3. A B-spline surface that is flat to within resolution_mm is a plane.

#pragma once

#include <functional>
#include <vector>

#include "kernel/geometry/surface.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

struct StatedSurface {
    Surface surface;
    // Whether the file's normal (d/du x d/dv of its parameters) is normal() of what the kernel has.
    bool same_sense = true;
    // Of a torus whose tube crosses the axis: the file says which sheet is meant; else the face's loops do.
    bool sheet_is_stated = false;
};

// Points that the loops of the face pass near: surfaces that have no end are made to reach beyond them.
using Boundary = std::function<std::vector<Point3>()>;

Result<StatedSurface> read_surface(const File& file, InstanceIndex user, InstanceIndex surface,
                                   const Units& units, const Boundary& boundary,
                                   part21::Trail& trail);

// A B-spline surface, as a plane if it is one.
StatedSurface stated(BSplineSurface surface);

// The same double cone from its other side, so that the nappe that was negative is the one meant.
Cone other_nappe(const Cone& cone);

// Radius and semi-angle of either sign, as contract 2 says; none if both are zero.
std::optional<Surface> upright_cone(Cone cone);

}  // namespace lyr::importer
