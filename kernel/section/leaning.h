// How far the surfaces of a section lean out over what is below them, by their exact normals.
//
// At a point of a section the surface leans out by the angle between it and the vertical: 0 of an upright wall, 90
// degrees of a flat underside, negative where it faces up.
//
// Contract
//  1. The spans are those stretches of each face's section that lean out by more than the limit, in the section's direction
//     (the material on the left). They end with the face's section, or where the lean passes the limit: at the parameter
//     where the normal does, found by bisection on the curve itself.
//  2. A surface that leans by just the limit does not pass it: lean_resolution_rad is allowed for.
//  3. Spans of the faces themselves: where solids overlap or a section crosses itself, they are not on its outline.
//
// A stretch is found if it holds one of the places looked at, or if a parabola through three of them foretells it. They are
// 24 in a turn; on a free-form surface, those where its section is tracked, but no nearer than look_mm, and at least five.

#pragma once

#include <vector>

#include "kernel/brep/model.h"
#include "kernel/contour/contour.h"

namespace lyr {

// Files state directions to seven digits.
inline constexpr double lean_resolution_rad = 1e-6;

inline constexpr double look_mm = 0.1;

struct LeaningSpan {
    FaceId face;
    Path path;            // open, from its start
    double most_rad = 0;  // lean at any of the places looked at
};

}  // namespace lyr
