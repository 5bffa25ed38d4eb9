#include "slicer/overhang_walls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "kernel/toolpath/clip.h"
#include "kernel/toolpath/offset.h"

namespace lyr::slicer {
namespace {

// In two halves, as circles are cut at their ends only.
Path path_of(const Strand& wall, const Point2& start) {
    const auto* circle = std::get_if<FullCircle>(&wall.path);
    if (!circle) return std::get<Path>(wall.path);
    const Point2 opposite = 2 * circle->centre - start;
    const double sagitta_mm = circle->counter_clockwise ? circle->radius_mm : -circle->radius_mm;
    return {start, {{opposite, sagitta_mm}, {start, sagitta_mm}}};
}

std::size_t end_of_stretch(const std::vector<bool>& inside, std::size_t first) {
    std::size_t last = first;
    while (last < inside.size() && inside[last] == inside[first]) ++last;
    return last;
}

// Stretches that are too short become as the one before; the first one as the next.
void smooth(CutPath& cut, double least_mm) {
    Point2 from = cut.path.start;
    const std::vector<bool> inside = cut.inside;
    for (std::size_t first = 0, last = 0; first < inside.size(); first = last) {
        last = end_of_stretch(inside, first);
        double length = 0;
        for (std::size_t i = first; i < last; ++i) {
            length += length_mm(from, cut.path.segments[i]);
            from = cut.path.segments[i].end;
        }
        if (length >= least_mm || (first == 0 && last == inside.size())) continue;
        const bool as = first > 0 ? cut.inside[first - 1] : !inside[first];
        std::fill(cut.inside.begin() + static_cast<std::ptrdiff_t>(first),
                  cut.inside.begin() + static_cast<std::ptrdiff_t>(last), as);
    }
}

}  // namespace

std::optional<HeldWalls> HeldWalls::of(const OutlinedLayer& layer, const OutlinedLayer& below,
                                       const Options& options) {
    if (!options.profile.bridge.walls || !layer.seen.is_finite() || !below.seen.is_finite())
        return std::nullopt;
    // A wall over air has a disc of its width there.
    const double width_mm = options.profile.perimeters.width_mm;
    if (!may_leave_bare(layer.seen, below.seen, options.profile.skin.width_mm, width_mm))
        return std::nullopt;
    const OffsetResult held = offset(
        below.outline, {.distance_mm = width_mm / 2, .allowed_mm = options.tolerance().unite_mm()});
    if (held.unresolved) return std::nullopt;
    return HeldWalls(held.contours);
}

std::vector<WallStretch> HeldWalls::stretches(const Strand& wall, const Point2& start) const {
    CutPath cut = cut_at(path_of(wall, start), held_);
    smooth(cut, wall.width_mm);
    std::vector<WallStretch> result;
    Point2 from = cut.path.start;
    for (std::size_t first = 0, last = 0; first < cut.inside.size(); first = last) {
        last = end_of_stretch(cut.inside, first);
        if (first == 0 && last == cut.inside.size()) return {{wall, !cut.inside[0]}};
        Strand strand{Path{from, {}}, wall.width_mm};
        for (std::size_t i = first; i < last; ++i) {
            std::get<Path>(strand.path).segments.push_back(cut.path.segments[i]);
            if (!wall.widths_mm.empty()) strand.widths_mm.push_back(wall.widths_mm[cut.origin[i]]);
        }
        from = cut.path.segments[last - 1].end;
        result.push_back({std::move(strand), !cut.inside[first]});
    }
    return result;
}

}  // namespace lyr::slicer
