#include "kernel/toolpath/islands.h"

#include <algorithm>

namespace lyr {

Islands::Islands(Region region) {
    std::vector<std::size_t> outer;
    for (std::size_t i = 0; i < region.size(); ++i)
        if (area_mm2(region[i]) > 0) outer.push_back(i);
    for (const std::size_t i : outer) {
        islands_.push_back({count(), area_mm2(region[i]), region::box_of(region[i]),
                            Boundary(outer.size() == 1 ? Region() : region.subspan(i, 1))});
    }
    std::stable_sort(islands_.begin(), islands_.end(),
                     [](const Island& a, const Island& b) { return a.area_mm2 < b.area_mm2; });
}

std::uint32_t Islands::of(const Point2& point) const {
    if (count() == 1) return 0;
    for (const Island& island : islands_)
        if (island.box.contains(point) && island.outline.winding(point) > 0) return island.number;
    return count();
}

namespace {

// Contours that touch do so in corners.
Point2 clear_point(const Contour& contour) {
    const auto* path = std::get_if<Path>(&contour);
    return path ? point_at(path->start, path->segments.front(), 0.5) : start_of(contour);
}

}  // namespace

std::vector<std::vector<Contour>> parts_of(Region region) {
    const Islands islands(region);
    std::vector<std::vector<Contour>> parts;
    for (const Contour& contour : region)
        if (area_mm2(contour) > 0) parts.push_back({contour});
    for (const Contour& contour : region) {
        if (area_mm2(contour) > 0) continue;
        const std::uint32_t part = islands.of(clear_point(contour));
        if (part < parts.size()) parts[part].push_back(contour);
    }
    return parts;
}

}  // namespace lyr
