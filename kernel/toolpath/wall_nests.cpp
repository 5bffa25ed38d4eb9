#include "kernel/toolpath/wall_nests.h"

#include <algorithm>

#include "kernel/toolpath/boundary.h"

namespace lyr {
namespace {

// Walls are a width less a little apart, farther in corners that were mitred.
constexpr double reach_widths = 1.5;

double widest_mm(const Strand& wall) {
    if (wall.widths_mm.empty()) return wall.width_mm;
    return *std::max_element(wall.widths_mm.begin(), wall.widths_mm.end());
}

}  // namespace

WallNests wall_nests(std::span<const Strand> walls, std::span<const std::uint32_t> depths) {
    WallNests nests;
    nests.children.resize(walls.size());
    std::vector<std::vector<std::uint32_t>> by_depth;
    for (std::uint32_t i = 0; i < walls.size(); ++i) {
        if (by_depth.size() <= depths[i]) by_depth.resize(depths[i] + 1);
        by_depth[depths[i]].push_back(i);
    }
    std::vector<bool> has_parent(walls.size());
    for (std::size_t depth = 1; depth < by_depth.size(); ++depth) {
        const std::vector<std::uint32_t>& outward = by_depth[depth - 1];
        std::vector<Contour> contours;
        for (const std::uint32_t i : outward) contours.push_back(walls[i].path);
        const Boundary boundary(contours);
        for (const std::uint32_t i : by_depth[depth]) {
            const auto beside =
                boundary.nearest(start_of(walls[i].path), reach_widths * widest_mm(walls[i]));
            if (!beside) continue;
            nests.children[outward[boundary.pieces()[*beside].contour]].push_back(i);
            has_parent[i] = true;
        }
    }
    for (std::uint32_t i = 0; i < walls.size(); ++i)
        if (!has_parent[i]) nests.roots.push_back(i);
    return nests;
}

}  // namespace lyr
