// Ways for the empty head that stay inside a region, so that what drips does not mark a wall.
//
// The region is as in kernel/region: contours with the material on the left that wind around no point more than once.
//
// Contract
//  1. Unless a way `crosses`, no point of it is farther than `allowed_mm` outside the region, apart from ends that are.
//  2. It is straight where that is inside. Otherwise it bends around corners and arcs of the boundary, up to `clear_mm` from
//     them where there is room, else about twice `allowed_mm`, and is no more than `most_extra_mm` longer than the straight
//     way.
//  3. It is short, not always the shortest (docs/algorithms/order.md has figures). Where no such way is found (the ends lie
//     in separate parts, or outside, or the work is at its bound), it goes straight and `crosses` says so.
//
// Cost: n log n for the region; for a way about a microsecond where it is straight, some tens of them around a contour, and
// never more than a bounded number of questions to the boundary.

#pragma once

#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

struct Travel {
    std::vector<Point2> via{};  // between the ends
    bool crosses = false;       // the region's boundary
};

class Detours {
public:
    // What a retraction costs, in travel: a longer detour is not worth it.
    static constexpr double default_extra_mm = 20;

    Detours(Region inside, double allowed_mm, double most_extra_mm = default_extra_mm,
            double clear_mm = 0);

    Travel way(const Point2& from, const Point2& to) const;

private:
    // Where a way around the boundary may bend: beside a corner that juts into the region, or an arc that does.
    struct Bend {
        Point2 point;
        double at_mm;  // along its contour
    };
    struct Outline {
        double length_mm = 0;
        std::vector<Bend> bends{};  // by at_mm
    };
    class Search;

    void add_bends(const BoundaryPiece& before, const BoundaryPiece& piece, Outline& outline) const;
    Point2 moved_inside(Point2 point) const;

    Boundary boundary_;
    double allowed_mm_, most_extra_mm_, clear_mm_;
    std::vector<double> piece_at_mm_;  // along its contour
    std::vector<Outline> outlines_;    // by contour
};

}  // namespace lyr
