#include "slicer/support_order.h"

#include <optional>

#include "kernel/contour/turned_round.h"
#include "kernel/region/curve.h"

namespace lyr::slicer {
namespace {

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
