// Going around a part, the outline and what is beside it take turns: twice or more in a web, once in the end of a rib. A part
// that strands fill in one piece, from flank to flank, cuts nothing off; this is asked first, as nearly all parts are such.

#include "kernel/toolpath/lost_webs.h"

#include <algorithm>

#include "kernel/toolpath/islands.h"

namespace lyr {
namespace {

// In the least width: a point so far within a strand's part is within what it is a part of.
constexpr double inside_share = 0.25;

// In allowed_mm, how far the boundary of what is left of the outline may be off it.
constexpr double on_outline = 4;

std::size_t parts_within(Region narrow, Region part, double inside_mm) {
    const Boundary boundary(part);
    return static_cast<std::size_t>(
        std::count_if(narrow.begin(), narrow.end(), [&](const Contour& contour) {
            if (area_mm2(contour) <= 0) return false;
            const std::vector<BoundaryPiece> pieces = boundary_pieces({&contour, 1});
            if (pieces.empty()) return false;
            const Vector2 inwards = inside_mm * left_of(pieces.front().middle_tangent);
            return boundary.winding(pieces.front().middle + inwards) > 0;
        }));
}

}  // namespace

std::size_t sides_on(Region part, const Boundary& outline, double allowed_mm) {
    std::size_t count = 0;
    const std::vector<BoundaryPiece> pieces = boundary_pieces(part);
    const auto is_on = [&](const BoundaryPiece& piece) {
        return outline.is_near(piece.middle, on_outline * allowed_mm);
    };
    for_neighbours(pieces, [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
        count += !is_on(before) && is_on(piece);
    });
    return count;
}

std::optional<Point2> lost_web(Region rest, Region narrow, const Boundary& outline,
                               const WebRequest& request) {
    for (const std::vector<Contour>& part : parts_of(rest)) {
        const std::size_t filled = parts_within(narrow, part, inside_share * request.min_width_mm);
        if (filled == 1 || (filled == 0 && sides_on(part, outline, request.allowed_mm) < 2))
            continue;
        const RegionResult left = combined(part, narrow, Operation::subtract, request.allowed_mm);
        for (const std::vector<Contour>& web : parts_of(left.contours))
            if (sides_on(web, outline, request.allowed_mm) >= 2)
                return region::box_of(web.front()).center();
    }
    return std::nullopt;
}

}  // namespace lyr
