// The untrimmed section of a free-form surface with the plane z = h, tracked from cell to cell.
//
// Contract
//  1. Every component is found, rings that touch no border of the surface too; only what lies within flat_cell_mm of the
//     plane may be joined differently from the exact section, or be missing.
//  2. A curve runs along z x n, n = d/du x d/dv (or against it, `forward` false): the solid is on its left.
//  3. Its points lie on surface and plane within resolution_mm. The cubics through neighbours (between()) stay within
//     `allowed_mm` of the exact section: checked in the middle of each span of twice the length. Where the section has
//     a corner that shows by that much, the same point is there twice, with the tangents before and after; but a closed
//     curve's first and last point are these two.
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
    Point2 uv;  // of one of its points
    bool closes_in_corner = false;

    double length_mm() const { return key.back(); }
};

// The cubic with the points and tangents of two neighbours, at a share of the way; the chord's length is its speed at
// both ends.
CurvePoint between(const CurvePoint& start, const CurvePoint& end, double share);

// How far a curve that turns by these angles against its chord strays from it, in first order.
double sagitta_mm(const CurvePoint& start, const CurvePoint& end);

std::vector<LevelCurve> level_curves(const HeightMesh& mesh, double z_mm, bool forward,
                                     double allowed_mm);

}  // namespace lyr
