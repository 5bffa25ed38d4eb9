// Surfaces of ISO 10303-42 as the kernel's surfaces.
//
// Contract
//  1. PLANE, CYLINDRICAL_, CONICAL_, SPHERICAL_ and TOROIDAL_SURFACE. Anything else is an error, status unsupported.
//  2. The kernel's cone opens along its axis from a radius >= 0: a negative semi-angle turns the axis around, a
//     negative radius moves the origin to the apex. A semi-angle of zero is a cylinder.

#pragma once

#include "kernel/geometry/surface.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

Result<Surface> read_surface(const File& file, InstanceIndex user, InstanceIndex surface,
                             const Units& units);

// The same double cone from its other side, so that the nappe that was negative is the one meant.
Cone other_nappe(const Cone& cone);

}  // namespace lyr::importer
