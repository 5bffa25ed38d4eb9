// Where support stands: the areas under overhangs, taken down layer by layer to the bed or to the part.
//
// Contract
//  1. The support of a layer is nowhere nearer than gap_xy_mm to the part in that layer, and there is no part over or
//     under it that is nearer than gap_z_mm, as heights of layers go: the air is at least as high as the gap.
//  2. Support reaches out beside the part that hangs over it by gap_xy_mm, or by a line if that is more: there is room for
//     a line under a point too; and by both where no line fits otherwise, as under the uppermost edge of a slope. What an
//     overhang asks for begins in the highest layer that leaves the gap under it, and goes on downwards, apart from what 1
//     takes away: to the bed, to the part, or, with `on_bed_only`, not at all if that is not the bed. It lies over
//     support or the part, but for gaps between these of up to gap_xy_mm.
//  3. Interfaces are the `interface_layers` highest layers under an overhang, and as many over the part where support stands
//     on it. With sparse support they share the corners where they meet.
//  4. An overhang that is so near to the bed that no layer fits between them is not supported: it lies within the gap over it.
//  5. Overhangs of which nothing wide enough for a line can be held, but for 4 and `on_bed_only`, are in `out_of_reach`.
//
// Work on one layer by itself (room_of, divided) can be done in any order and on any number of threads.

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernel/region/region.h"

namespace lyr {

struct SupportRequest {
    double gap_z_mm = 0.2, gap_xy_mm = 0.4;
    std::size_t interface_layers = 2;
    bool on_bed_only = false;
    double width_mm = 0.45;  // of a line
    double allowed_mm = 0;
};

struct SupportLevel {
    double bottom_mm, top_mm;
    Region part{};      // the layer's outline
    Region overhang{};  // of the layer, for support below it
};

// What a layer leaves to support: the region that its own support keeps clear of, and where its overhang's begins below.
struct LayerRoom {
    std::vector<Contour> clear{}, contact{};
    std::size_t unresolved = 0;
};
LayerRoom room_of(std::span<const SupportLevel> levels, std::size_t layer,
                  const SupportRequest& request);

struct SupportAreas {
    std::vector<std::vector<Contour>> layers{};
    std::vector<std::size_t>
        out_of_reach{};                     // layers with overhangs that nothing can be built under
    std::vector<std::size_t> unresolved{};  // layers with regions that could not be worked out
};

// `rooms`: of every layer, from room_of(); those over the highest overhang may be empty.
SupportAreas support_areas(std::span<const SupportLevel> levels, std::span<const LayerRoom> rooms,
                           const SupportRequest& request);

struct DividedSupport {
    std::vector<Contour> sparse{}, interface {};
    std::size_t unresolved = 0;
};

// `inside`: the layer's support, or what of it is within its walls.
DividedSupport divided(Region inside, std::span<const SupportLevel> levels, std::size_t layer,
                       const SupportRequest& request);

// The layer in which the support of a layer's overhang begins; none: levels.size().
std::size_t highest_support(std::span<const SupportLevel> levels, std::size_t layer,
                            double gap_z_mm);

// By layer: the layers whose overhangs' support begins there.
std::vector<std::vector<std::size_t>> beginnings(std::span<const SupportLevel> levels,
                                                 std::span<const LayerRoom> rooms, double gap_z_mm);

}  // namespace lyr
