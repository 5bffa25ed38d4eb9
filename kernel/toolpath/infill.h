// The inside of a layer as lines: solid or sparse, in the patterns that users know.
//
// Contract
//  1. Lines are as far apart as makes the volume of a large region `density` times that of its area and the layer's
//     height; patterns that change from layer to layer do so on average. A strand of width w and height h is a rounded
//     rectangle, so at density 1 lines lie w - h (1 - pi/4) apart.
//  2. The region bounds the middles of the lines. Runs' links leave it by no more than `allowed_mm` and a twentieth of
//     the width, everything else by no more than `allowed_mm`.
//  3. Lines are in register: the same place has the same line whatever the region is.
//  4. Straight, dense lines are runs, everything else is strands, linked along the region's boundary where the
//     way is short. Every line is in the result once; those shorter than `allowed_mm` are left out.
//  5. At density 1 patterns that cross themselves are rectilinear.
//  6. Where nothing can be made of a request, because numbers are not finite or out of range, or an offset could not be
//     settled, `unresolved` counts it.
//  7. Between dense lines and the boundary no gap is wider than half their spacing, and none of its parts is empty but
//     those that are points (`left_out`).

#pragma once

#include <cstddef>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/hatch_runs.h"
#include "kernel/toolpath/strand.h"

namespace lyr {

enum class InfillPattern {
    rectilinear,  // parallel lines, from layer to layer across
    aligned,      // parallel lines, the same in every layer
    grid,         // lines of two directions in each layer
    triangles,    // of three
    concentric,   // along the boundary
    honeycomb,    // hexagons; walls between two strands are double
    gyroid,       // slices of sin x cos y + sin y cos z + sin z cos x = 0, as arcs
    cubic,        // cubes that stand on a corner
};

struct InfillRequest {
    InfillPattern pattern = InfillPattern::rectilinear;
    double density = 1;  // of the volume, in (0, 1]
    double width_mm = 0.45, height_mm = 0.2;
    double angle_rad = 0;
    double z_mm = 0;
    std::size_t layer = 0;
    double allowed_mm = 0;
};

struct Fill {
    std::vector<HatchRun> runs{};
    std::vector<Strand> strands{};
    std::size_t unresolved = 0;
    std::size_t left_out = 0;  // see 7; of concentric fill, parts narrower than `allowed_mm`
};

// Between strands that lie side by side without a gap.
double line_spacing_mm(double width_mm, double height_mm);

// `inside` with the material on the left, winding around no point more than once, as those of a section or of
// united() do.
Fill infill(Region inside, const InfillRequest& request);

}  // namespace lyr
