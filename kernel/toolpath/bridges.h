// In which direction a bridge is hatched: across the air, from one side that holds it to another.
//
// Contract
//  1. A line is held where its end, or the place half a line's spacing beyond it, is over the region below. Of all
//     directions, that one is taken in which the most of the bridge is on lines held at both ends; of those that are
//     as good within a fiftieth, the one whose longest line is the shortest; of those that are as short within a
//     fiftieth, edges of the bridge come first.
//  2. Directions asked are those of the bridge's longer straight edges, those across them, and 36 all round (over
//     lines: 12).
//  3. Where no direction has at least half of the bridge held so, there is none: an overhang.
//  4. The angle is in [0, pi). It turns with bridge and region.
//  5. A bridge inside the part is held by the region below but for its sparse fill, and by the lines of that. Of its lines
//     the stretches between what holds them count; in place of the longest line, the mean length of the stretch that a
//     point of the bridge is on, within a tenth, a free stretch at an end that nothing holds as if twice as long. So lines
//     that are parallel are crossed at right angles. Where there are no lines, contract 1 holds as it is.
//
// Lines are held better if the bridge reaches over its edge, as skins_of() makes it.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/infill.h"

namespace lyr {

struct Bridge {
    std::vector<Contour> contours;    // an outer one and its holes
    std::optional<double> angle_rad;  // none: an overhang
};

// Each part of the bridges for itself.
std::vector<Bridge> bridges_over(Region bridges, Region below, double spacing_mm);

// A straight piece of what holds bridges.
struct Chord {
    Point2 from, to;
};
std::vector<Chord> chords_of(const Fill& fill);

// Of bridges inside the part: held by the region below without its sparse fill, and by the lines of that.
std::vector<Bridge> bridges_inside(Region bridges, Region below, Region sparse_below,
                                   std::span<const Chord> lines, double spacing_mm);

// How a part is held in the direction of its bridge_angle().
struct BridgeSpan {
    double angle_rad = 0;
    double held = 0;        // the share of its rows, by their length, that is held at both ends
    double longest_mm = 0;  // of these rows
};
std::optional<BridgeSpan> bridge_span(Region bridge, Region below, double spacing_mm);

// Of one part.
std::optional<double> bridge_angle(Region bridge, Region below, double spacing_mm);

}  // namespace lyr
