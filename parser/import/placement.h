// Points, directions and local coordinate systems of ISO 10303-42.
//
// Contract
//  1. Frames are orthonormal and right-handed. Axes that are missing or parallel are chosen as the standard's
//     build_axes and base_axis do; where it has no answer (ref_direction along the axis), as if it were missing.
//  2. Coordinates are converted to millimetres. Directions have unit length; one without length is an error.

#pragma once

#include "kernel/geometry/vector.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

Result<Point3> read_point(const File& file, InstanceIndex user, InstanceIndex point,
                          const Units& units);
Result<Vector3> read_direction(const File& file, InstanceIndex user, InstanceIndex direction,
                               const Units& units);

// AXIS2_PLACEMENT_3D; within the parameters of a surface AXIS2_PLACEMENT_2D.
Result<Frame> read_frame(const File& file, InstanceIndex user, InstanceIndex placement,
                         const Units& units);

// AXIS1_PLACEMENT: a frame with the axis as its z.
Result<Frame> read_axis(const File& file, InstanceIndex user, InstanceIndex placement,
                        const Units& units);

// From the frame's own coordinates to those that it is stated in.
Eigen::Affine3d to_affine(const Frame& frame);

// Whether it is a CARTESIAN_TRANSFORMATION_OPERATOR_3D, simple or complex.
bool is_operator(const File& file, InstanceIndex item);

// AXIS2_PLACEMENT_3D or CARTESIAN_TRANSFORMATION_OPERATOR_3D, which may mirror and scale.
Result<Eigen::Affine3d> read_transform(const File& file, InstanceIndex user, InstanceIndex item,
                                       const Units& units);

}  // namespace lyr::importer
