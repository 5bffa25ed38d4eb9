// Curves in the parameters of a surface, taken into space. They are given with z = 0, as the file counts them.
//
// Contract
//  1. iso_line() is exact: any line on a plane, and lines along one parameter, of an offset sweep only where they are
//     lines and circles; else nothing.
//  2. lifted() is off by no more than lifted_accuracy_mm at the same parameters; nothing where the surface has no
//     normal to be offset along.
//  3. stretch_between() is the part of a curve without ends that leads from one point of the surface to another, in the
//     curve's sense or against it: of what passes through them more than once, the part that begins nearest to the
//     curve's own origin, and no longer than it has to be. Around a closed curve if both are one. Nothing if there is
//     no such part.

#pragma once

#include <optional>

#include "kernel/geometry/tolerance.h"
#include "parser/import/curves.h"
#include "parser/import/parameter_space.h"
#include "parser/import/profile.h"

namespace lyr::importer {

inline constexpr double lifted_accuracy_mm = resolution_mm / 4;

std::optional<DirectedCurve> iso_line(const ParameterSpace& space, const Line& line);

std::optional<BSplineCurve> lifted(const ParameterSpace& space, const BSplineCurve& curve);

// Points farther than `closeness_mm` from the curve count only if there are no nearer ones.
std::optional<Stretch> stretch_between(const ParameterSpace& space, const Curve& curve,
                                       const Ends& ends, double closeness_mm);

}  // namespace lyr::importer
