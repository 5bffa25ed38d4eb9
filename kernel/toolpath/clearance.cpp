#include "kernel/toolpath/clearance.h"

#include <cmath>
#include <numbers>
#include <optional>

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

// Of a passage, along one side. It begins and ends where its sides are as far apart as a disc is wide, and their angle has
// a half with this sine.
double lost_mm2(double run_mm, double half_angle_sine, double width_mm, double mitre_limit) {
    const double radius_mm = width_mm / 2;
    const double between = std::max(0.0, run_mm - short_passage * width_mm);
    const double beside_discs = radius_mm * (between + beside_share * (run_mm - between));
    if (half_angle_sine * mitre_limit < 1) return beside_discs;
    // Mitres make wedges from both ends, as wide as the passage there. Its sides are taken for parabolas.
    const double cosine = std::sqrt(1 - half_angle_sine * half_angle_sine);
    const double wedge_mm = radius_mm * cosine / half_angle_sine;
    const double wedged_mm = std::min(run_mm, 2 * wedge_mm);
    const double beside_wedges =
        radius_mm * (run_mm - wedged_mm + wedged_mm * wedged_mm / (12 * wedge_mm));
    return std::min(beside_discs, beside_wedges);
}

// Along one side of a boundary.
struct NarrowRun {
    double length_mm = 0;
    double first_sine = 0, last_sine = 0;  // of half the angle between the sides, at its ends

    void add(double step_mm, double sine) {
        if (length_mm == 0) first_sine = sine;
        length_mm += step_mm;
        last_sine = sine;
    }
};

// Sides that lead in the same direction are none of a passage.
double half_angle_sine(const Vector2& side, const Vector2& opposite) {
    return std::sqrt(std::max(0.0, (1 + side.dot(opposite)) / 2));
}

region::Box2 grown(const region::Box2& box, double by_mm) {
    const Vector2 margin(by_mm, by_mm);
    return {box.min() - margin, box.max() + margin};
}

}  // namespace

double narrow_mm2(const Boundary& boundary, double width_mm, double mitre_limit) {
    const std::vector<BoundaryPiece>& pieces = boundary.pieces();
    const Turns turns(pieces);
    const double radius_mm = width_mm / 2;
    double lost = 0;
    NarrowRun run;
    const auto end_run = [&] {
        lost +=
            lost_mm2(run.length_mm, std::min(run.first_sine, run.last_sine), width_mm, mitre_limit);
        run = {};
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const BoundaryPiece& piece = pieces[i];
        const auto in_the_way = [&](const region::Box2& box, auto is_near) {
            return boundary.any(box, [&](std::uint32_t j) {
                return j != i && !turns.is_stretch(i, j, corner_turn_rad) && is_near(pieces[j]);
            });
        };
        // Where a disc meets another side, the sine of half the angle to it.
        const auto narrow_at = [&](const BoundaryPoint& place) {
            const Vector2 left(-place.tangent.y(), place.tangent.x());
            const Point2 centre = place.point + radius_mm * left;
            std::optional<double> sine;
            in_the_way(grown(region::Box2(centre), radius_mm), [&](const BoundaryPiece& other) {
                if (!(other.distance_mm(centre) < radius_mm - resolution_mm)) return false;
                sine =
                    half_angle_sine(place.tangent, region::tangent_beside(other.curve(), centre));
                return true;
            });
            return sine;
        };
        if (i > 0 && pieces[i - 1].contour != piece.contour) end_run();
        const bool is_open =
            !in_the_way(grown(piece.box(), width_mm), [](const auto&) { return true; });
        const double steps = is_open ? 1 : std::ceil(piece.length_mm / (step_share * width_mm));
        for (double k = 0.5; k < steps; ++k) {
            const auto sine = is_open ? std::nullopt : narrow_at(piece.at(k / steps));
            if (sine) {
                run.add(piece.length_mm / steps, *sine);
            } else {
                end_run();
            }
        }
    }
    end_run();
    return lost;
}

}  // namespace lyr
