#include "kernel/toolpath/turns.h"

#include <cmath>
#include <numbers>

namespace lyr {
namespace {

// No less than the angle between unit vectors.
double turn_bound_rad(const Vector2& from, const Vector2& to) {
    const double sine = std::abs(cross(from, to));
    return from.dot(to) > 0 ? std::numbers::pi / 2 * sine : std::numbers::pi - sine;
}

}  // namespace

Turns::Turns(const std::vector<BoundaryPiece>& pieces) : pieces_(pieces) {
    turned_.reserve(pieces.size());
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t next = first;
        double sum = 0;
        for (; next < pieces.size() && pieces[next].contour == pieces[first].contour; ++next) {
            const double start = sum;
            sum += std::abs(pieces[next].curvature_per_mm) * pieces[next].length_mm;
            turned_.push_back({start, sum, 0});
            const bool is_last =
                next + 1 == pieces.size() || pieces[next + 1].contour != pieces[first].contour;
            const BoundaryPiece& after = pieces[is_last ? first : next + 1];
            sum += turn_bound_rad(pieces[next].end_tangent, after.start_tangent);
        }
        for (; first < next; ++first) turned_[first].round_rad = sum;
    }
}

}  // namespace lyr
