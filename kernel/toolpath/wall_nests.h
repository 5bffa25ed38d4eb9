// Walls that run beside each other, from the outermost inwards.
//
// Contract: the parent of a wall is the next one outwards beside it: it passes the wall's start within one and a half
// widths. A wall without one (all outermost ones are) is a root.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kernel/toolpath/strand.h"

namespace lyr {

struct WallNests {
    std::vector<std::uint32_t> roots{};                  // as the walls follow each other
    std::vector<std::vector<std::uint32_t>> children{};  // by wall
};

// Depth 0 is the outermost.
WallNests wall_nests(std::span<const Strand> walls, std::span<const std::uint32_t> depths);

}  // namespace lyr
