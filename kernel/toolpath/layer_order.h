// The sequence in which a layer is printed: its walls, and all the pieces that have ends.
//
// Contract
//  1. Every wall and every piece is printed once.
//  2. What is of one part of the region comes together, and within it stages one after the other, in rising order. Walls
//     are a stage of their own among those of the pieces.
//  3. Walls beside each other come together too, from the inside outwards or the reverse.
//  4. The outermost walls begin at the seams that are given, walls within next to them; where none are given, all next to
//     where the head is.
//  5. Each move says how the head gets to its start: straight, or as `detours` has it.
//
// Seams of a layer depend on those of the layer below, all else does not: outer_seams() is a quick pass over the layers
// in order, after their walls have been made and before each is ordered, both on any thread.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/toolpath/detour.h"
#include "kernel/toolpath/seam.h"

namespace lyr {

enum class WallSequence { inner_first, outer_first };

// A line, a strand or a run, which can be printed from either end.
struct OpenPiece {
    Point2 first, last;
    std::uint32_t stage = 1;
};

struct LayerPlan {
    Region region;                          // whose parts are printed one after the other
    std::span<const Strand> walls;          // closed
    std::span<const std::uint32_t> depths;  // by wall; 0: outermost
    std::span<const Seam> seams{};          // of the outermost walls, in their order; or none
    std::span<const OpenPiece> pieces{};
    WallSequence sequence = WallSequence::inner_first;
    std::uint32_t wall_stage = 0;
    Point2 head = Point2::Zero();
    const Detours* detours =
        nullptr;  // none: every way is straight, and none is asked whether it crosses
};

struct PrintMove {
    bool is_wall;
    std::uint32_t index;        // among the walls, or the pieces
    bool reversed = false;      // of a piece: from last to first
    Seam seam{Point2::Zero()};  // of a wall: started_at() of seam.h gives what is printed
    Travel travel{};            // to its start
};

std::vector<PrintMove> layer_order(const LayerPlan& plan);

// Of the outermost walls, in their order; their points are `below` for the next layer. None if the choice is nearest: it
// depends on the order.
std::vector<Seam> outer_seams(std::span<const Strand> walls, std::span<const std::uint32_t> depths,
                              SeamChoice choice, std::span<const Seam> below);

}  // namespace lyr
