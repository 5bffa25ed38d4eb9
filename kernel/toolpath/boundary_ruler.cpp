#include "kernel/toolpath/boundary_ruler.h"

#include <algorithm>

namespace lyr {
namespace {

// The part between two lengths from the start, which end in these points.
Segment part_of(const BoundaryPiece& piece, const BoundaryPlace& from, const BoundaryPlace& to) {
    return arc_with_sweep(from.point, to.point,
                          piece.curvature_per_mm * (to.along_mm - from.along_mm));
}

}  // namespace

BoundaryPlace place_on(std::span<const BoundaryPiece> boundary, std::uint32_t piece,
                       const Point2& point) {
    const region::Curve curve = boundary[piece].curve();
    // Round-off may take it just out of the piece.
    const double along = std::clamp(region::along_mm(curve, point), -curve.half_mm, curve.half_mm);
    return {piece, along + curve.half_mm, point};
}

BoundaryRuler::BoundaryRuler(std::span<const BoundaryPiece> pieces) : pieces_(pieces) {
    piece_start_mm_.reserve(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        const std::uint32_t contour = pieces[i].contour;
        if (contour >= contours_.size()) contours_.resize(contour + 1);
        ContourPieces& of = contours_[contour];
        if (of.length_mm == 0) of.first = i;
        piece_start_mm_.push_back(of.length_mm);
        of.last = i + 1;
        of.length_mm += pieces[i].length_mm;
    }
}

std::uint32_t BoundaryRuler::next(std::uint32_t piece) const {
    const ContourPieces& of = contours_[pieces_[piece].contour];
    return piece + 1 == of.last ? of.first : piece + 1;
}

void BoundaryRuler::append_forward(const BoundaryPlace& from, const BoundaryPlace& to,
                                   std::vector<Segment>& way) const {
    BoundaryPlace at = from;
    const auto ends_here = [&] { return at.piece == to.piece && at.along_mm <= to.along_mm; };
    // A whole contour and what is left of its first piece is the longest way.
    for (std::size_t passed = 0; !ends_here() && passed <= pieces_.size(); ++passed) {
        const BoundaryPiece& piece = pieces_[at.piece];
        const BoundaryPlace end{at.piece, piece.length_mm, piece.end};
        if (at.point != end.point || at.along_mm < end.along_mm)
            way.push_back(part_of(piece, at, end));
        at = {next(at.piece), 0, piece.end};
    }
    way.push_back(part_of(pieces_[at.piece], at, to));
}

void BoundaryRuler::append_backward(const BoundaryPlace& from, const BoundaryPlace& to,
                                    std::vector<Segment>& way) const {
    std::vector<Segment> forward;
    append_forward(to, from, forward);
    for (std::size_t i = forward.size(); i-- > 0;) {
        way.push_back({i == 0 ? to.point : forward[i - 1].end, -forward[i].sagitta_mm});
    }
}

}  // namespace lyr
