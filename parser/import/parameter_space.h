// Surfaces as files count on them: with the parameters of ISO 10303-42, for curves that are stated in these.
//
// Contract
//  1. Every surface that surfaces.h reads, of which a swept curve has parameters of its own (no trimmed or composite
//     curve), else an error, status unsupported.
//  2. point() at the file's parameters is the surface's point in millimetres.
//  3. The parameters of a rectangular trimmed surface begin at zero where it begins, as ISO 10303-42 has them, or
//     (`trims_from_zero` false) are those of its basis, which some systems write.

#pragma once

#include <variant>

#include "kernel/geometry/surface.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

// curve(u) + v direction
struct Extrusion {
    Curve curve;
    Vector3 direction;
};

// curve(v), turned by u about the axis.
struct Revolution {
    Curve curve;
    Frame axis;
};

struct ParameterSpace {
    std::variant<Plane, Cylinder, Cone, Sphere, Torus, SharedBSplineSurface, Extrusion, Revolution>
        basis;
    // What the file counts in, times `scale`, plus `shift`, are the parameters of `basis`.
    Vector2 scale = Vector2::Ones(), shift = Vector2::Zero();
    double offset_mm = 0;  // along d/du x d/dv of `basis`
    Eigen::Affine3d to_space = Eigen::Affine3d::Identity();

    Point2 of_basis(const Point2& in_file) const { return in_file.cwiseProduct(scale) + shift; }
};

Result<ParameterSpace> read_parameter_space(const File& file, InstanceIndex user,
                                            InstanceIndex surface, const Units& units,
                                            bool trims_from_zero, part21::Trail& trail);

}  // namespace lyr::importer
