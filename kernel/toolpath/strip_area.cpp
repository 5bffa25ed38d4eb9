#include "kernel/toolpath/strip_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/toolpath/offset_curve.h"

namespace lyr {
namespace {

using std::numbers::pi;

double beside_mm2(const BoundaryPiece& piece, double distance_mm) {
    const double turned = distance_mm > 0 ? piece.curvature_per_mm : -piece.curvature_per_mm;
    const double far_mm = std::abs(distance_mm);
    // Up to the centre of an arc that turns towards that side.
    const double depth_mm = std::min(far_mm, turned < 0 ? -1 / turned : far_mm);
    return piece.length_mm * depth_mm * (1 + turned * depth_mm / 2);
}

double around_mm2(const BoundaryPiece& before, const BoundaryPiece& after, double distance_mm,
                  double mitred_mm) {
    const Vector2 &from = before.end_tangent, &to = after.start_tangent;
    const double sine = cross(from, to), cosine = from.dot(to), far_mm = std::abs(distance_mm);
    // A cusp may be taken for either.
    const bool is_cusp = cosine < 0 && std::abs(sine) < cusp_rad;
    if (!is_cusp && (sine > 0) != (distance_mm > 0)) return 0;
    const double turn = is_cusp ? pi + cusp_rad : std::abs(std::atan2(sine, cosine));
    const bool mitred = mitred_mm * std::cos(turn / 2) >= far_mm && turn < pi && mitred_mm > far_mm;
    return far_mm * far_mm * (mitred ? std::tan(turn / 2) : turn / 2);
}

}  // namespace

double strip_mm2(const Boundary& boundary, double distance_mm, double mitred_mm) {
    double sum = 0;
    for_neighbours(boundary.pieces(), [&](const BoundaryPiece& before, const BoundaryPiece& piece) {
        sum += beside_mm2(piece, distance_mm);
        if (!piece.is_circle) sum += around_mm2(before, piece, distance_mm, mitred_mm);
    });
    return sum;
}

}  // namespace lyr
