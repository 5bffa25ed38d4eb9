// The untrimmed section of a free-form surface with the plane z = h, tracked from cell to cell.
//
// Contract
//  1. Every component is found, rings that touch no border of the surface too; only what lies within flat_cell_mm of the
//     plane may be joined differently from the exact section, or be missing.
//  2. A curve runs along z x n, n = d/du x d/dv (or against it, `forward` false): the solid is on its left.
//  3. Its points lie on surface and plane within resolution_mm, its chords within `chord_error_mm` of the exact section.
//     Where the section has a corner, the same point is there twice, with the tangents before and after.
//  4. key is the length along the chords from the curve's first point. A closed curve's last point is its first.

#pragma once

#include <vector>

#include "kernel/contour/fit.h"
#include "kernel/section/height_mesh.h"

namespace lyr {

struct LevelCurve {
    std::vector<CurvePoint> points;
    std::vector<double> key;
    bool closed;

    double length_mm() const { return key.back(); }
};

std::vector<LevelCurve> level_curves(const HeightMesh& mesh, double z_mm, bool forward,
                                     double chord_error_mm);

}  // namespace lyr
