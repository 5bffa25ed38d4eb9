#include "kernel/toolpath/clearance.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/turns.h"

namespace lyr {
namespace {

// Corners that turn by more are too sharp for a nozzle.
constexpr double corner_turn_rad = std::numbers::pi - 0.4;

// In the width.
constexpr double step_share = 0.25;

// Discs that come from both ends into a passage this many times as long as they are wide, or shorter, leave but that share
// of it: what lies beside them. Of a longer one they leave the rest too.
constexpr double short_passage = 1.25, beside_share = 0.1;

// Along one side.
double lost_mm2(double run_mm, double width_mm) {
    const double between = std::max(0.0, run_mm - short_passage * width_mm);
    return width_mm / 2 * (between + beside_share * (run_mm - between));
}

region::Box2 grown(const region::Box2& box, double by_mm) {
    const Vector2 margin(by_mm, by_mm);
    return {box.min() - margin, box.max() + margin};
}

}  // namespace

double narrow_mm2(const Boundary& boundary, double width_mm) {
    const std::vector<BoundaryPiece>& pieces = boundary.pieces();
    const Turns turns(pieces);
    const double radius_mm = width_mm / 2;
    double lost = 0, run_mm = 0;
    const auto end_run = [&] { lost += lost_mm2(std::exchange(run_mm, 0), width_mm); };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const BoundaryPiece& piece = pieces[i];
        const auto in_the_way = [&](const region::Box2& box, auto is_near) {
            return boundary.any(box, [&](std::uint32_t j) {
                return j != i && !turns.is_stretch(i, j, corner_turn_rad) && is_near(pieces[j]);
            });
        };
        const auto is_narrow_at = [&](const BoundaryPoint& place) {
            const Vector2 left(-place.tangent.y(), place.tangent.x());
            const Point2 centre = place.point + radius_mm * left;
            return in_the_way(grown(region::Box2(centre), radius_mm),
                              [&](const BoundaryPiece& other) {
                                  return other.distance_mm(centre) < radius_mm - resolution_mm;
                              });
        };
        if (i > 0 && pieces[i - 1].contour != piece.contour) end_run();
        const bool is_open =
            !in_the_way(grown(piece.box(), width_mm), [](const auto&) { return true; });
        const double steps = is_open ? 1 : std::ceil(piece.length_mm / (step_share * width_mm));
        for (double k = 0.5; k < steps; ++k) {
            if (!is_open && is_narrow_at(piece.at(k / steps))) {
                run_mm += piece.length_mm / steps;
            } else {
                end_run();
            }
        }
    }
    end_run();
    return lost;
}

}  // namespace lyr
