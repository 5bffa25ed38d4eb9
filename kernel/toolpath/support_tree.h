// Support as a tree: tips under overhangs, which lean together into branches on the way down.
//
// Contract
//  1. The gaps are those of support_areas.h, 1, and so is what counts as out of reach.
//  2. A tip stands in the layer where support of an overhang begins. Every place of that, half a line's width within, is no
//     farther than 1.25 spacing_mm from a tip, be it of a layer nearby; but with `on_bed_only` where none reaches it.
//  3. From layer to layer a branch moves aside by no more than its height times the tangent of branch_angle_rad. It goes to
//     the bed if it can; else, unless `on_bed_only`, down to the part.
//  4. Branches are full circles, where nothing cuts them: of tip_radius_mm at the tip, wider by growth_angle_rad on the way
//     down, up to most_radius_mm. Where two meet they go on as one.
//  5. The interface_layers highest layers under an overhang are all that support_areas.h would have there: a roof on tips.

#pragma once

#include <numbers>

#include "kernel/toolpath/support_areas.h"

namespace lyr {

struct TreeRequest {
    SupportRequest support;
    double tip_radius_mm = 0.6, most_radius_mm = 3;
    double branch_angle_rad = 40 * std::numbers::pi / 180;
    double growth_angle_rad = 5 * std::numbers::pi / 180;
    double spacing_mm = 3;
};

// `rooms`: of every layer, as for support_areas().
SupportAreas support_tree(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
                          const TreeRequest& request);

}  // namespace lyr
