// Checks of a sweep's result by means that it does not use itself.
//
// Contract
//  1. windings_agree(): for each input contour, the windings on both sides of the longest edge on it are those that a
//     ray to infinity counts over the input as it was given.
//  2. is_closed(): every boundary edge has its follower.
//  3. area_mm2() is the area of all points, as the sweep has it, each as often as it counts.

#pragma once

#include "kernel/region/sweep.h"

namespace lyr::region {

bool windings_agree(std::span<const Input> inputs, const Arrangement& arrangement,
                    const Sweep& sweep, double snap_mm);

bool is_closed(const Sweep& sweep);

// How often what has these windings counts; what is outside of everything, not at all.
using Counts = std::function<int(const Winding&)>;

double area_mm2(const Arrangement& arrangement, const Sweep& sweep, const Counts& counts);

bool is_finite(const Contour& contour);

}  // namespace lyr::region
