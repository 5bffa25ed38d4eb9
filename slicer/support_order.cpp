#include "slicer/support_order.h"

#include <optional>

#include "kernel/region/curve.h"

namespace lyr::slicer {
namespace {

// The same boundary with the material on its other side.
Contour turned_round(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour))
        return FullCircle{circle->centre, circle->radius_mm, !circle->counter_clockwise};
    const Path& path = std::get<Path>(contour);
    Path back{path.start, {}};
    for (std::size_t i = path.segments.size(); i-- > 0;)
        back.segments.push_back(
            {i > 0 ? path.segments[i - 1].end : path.start, -path.segments[i].sagitta_mm});
    return back;
}

// Beside the part, as far as the head may have to go.
std::vector<Contour> outside_of(Region part, std::span<const OpenPiece> pieces) {
    region::Box2 box;
    for (const OpenPiece& piece : pieces) box.extend(piece.first).extend(piece.last);
    std::vector<Contour> region;
    for (const Contour& contour : part) {
        box.extend(region::box_of(contour));
        region.push_back(turned_round(contour));
    }
    const Vector2 margin = Vector2::Constant(Detours::default_extra_mm);
    const Point2 low = box.min() - margin, high = box.max() + margin;
    region.push_back(Path{low, {{{high.x(), low.y()}}, {high}, {{low.x(), high.y()}}, {low}}});
    return region;
}

}  // namespace

std::vector<PrintMove> support_order(std::span<const OpenPiece> pieces, Region part,
                                     double allowed_mm) {
    if (pieces.empty()) return {};
    std::optional<Detours> outside;
    if (!part.empty()) outside.emplace(outside_of(part, pieces), allowed_mm);
    std::vector<PrintMove> moves = layer_order({.region = {},
                                                .walls = {},
                                                .depths = {},
                                                .pieces = pieces,
                                                .detours = outside ? &*outside : nullptr});
    for (PrintMove& move : moves) move.travel.crosses = true;
    return moves;
}

Point2 head_after(std::span<const PrintMove> moves, std::span<const OpenPiece> pieces) {
    if (moves.empty()) return Point2::Zero();
    const OpenPiece& last = pieces[moves.back().index];
    return moves.back().reversed ? last.first : last.last;
}

}  // namespace lyr::slicer
