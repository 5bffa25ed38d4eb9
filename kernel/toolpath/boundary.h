// The boundary of a region as it is asked about points and straight ways: how far it is, how often it winds around, and
// where it is crossed.
//
// Contract
//  1. winding() counts at any point, also where a contour's segments meet; on the boundary itself it is that of one of
//     its sides.
//  2. distance_mm() is exact up to `within_mm`; beyond that it is `within_mm`. nearest() is the piece of that distance.
//  3. crossings() are where pieces change the sides of a line, an end being left of it or not: every contour crosses a
//     whole line as often in as out. A touch is none, or two.
//  4. is_near() says whether any piece (but for one, given by its place among pieces()) comes so near to the point.
//
// Cost: log n for each question and what is near (or, for the winding, to the right; for crossings, on the way) besides.

#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/region/box_tree.h"
#include "kernel/region/region.h"

namespace lyr {

struct BoundaryPoint {
    Point2 point;
    Vector2 tangent;  // unit
};

// A segment, or a full circle, which has no ends.
struct BoundaryPiece {
    Point2 start, end;
    Vector2 start_tangent, end_tangent;
    Point2 middle;
    Vector2 middle_tangent;
    double curvature_per_mm;  // positive: turns left
    double length_mm;
    std::uint32_t contour;
    bool is_circle = false;
    bool is_wide = false;  // more than half a circle

    Carrier carrier() const { return {start, start_tangent, curvature_per_mm}; }
    BoundaryPoint at(double fraction) const;
    region::Curve curve() const {
        return {start, end, middle, middle_tangent, curvature_per_mm, length_mm / 2};
    }
    double distance_mm(const Point2& point) const;
    // Not the least one.
    region::Box2 box() const;
};

// Calls take(before, piece) for every piece of closed contours, in their order, with the one that it follows. A full
// circle follows itself.
template <class Take>
void for_neighbours(const std::vector<BoundaryPiece>& pieces, Take take) {
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t last = first;
        while (last + 1 < pieces.size() && pieces[last + 1].contour == pieces[first].contour) {
            ++last;
        }
        for (std::size_t i = first; i <= last; ++i)
            take(pieces[i == first ? last : i - 1], pieces[i]);
        first = last + 1;
    }
}

struct BoundaryCrossing {
    double along_mm;  // from the way's start
    std::uint32_t piece;
    bool leaves;  // the region, on the way
};

// In the order of the contours. Segments without length are left out.
std::vector<BoundaryPiece> boundary_pieces(Region region);

class Boundary {
public:
    static constexpr auto none = static_cast<std::size_t>(-1);

    explicit Boundary(Region region);

    const std::vector<BoundaryPiece>& pieces() const { return pieces_; }
    double distance_mm(const Point2& point, double within_mm) const;
    // Of two points that are near each other.
    std::pair<double, double> distances_mm(const Point2& a, const Point2& b,
                                           double within_mm) const;
    bool is_near(const Point2& point, double within_mm, std::size_t except = none) const;
    // The piece that was found last, for points that go along the boundary: that one and the next are looked at first.
    struct Guess {
        std::size_t piece = 0;
    };
    bool is_near(const Point2& point, double within_mm, Guess& guess) const;
    std::optional<std::uint32_t> nearest(const Point2& point, double within_mm) const;
    int winding(const Point2& point) const;
    // Strictly between the ends, in their order, in place of what `found` held.
    void crossings(const Point2& from, const Point2& to,
                   std::vector<BoundaryCrossing>& found) const;

    // Whether holds(index) is true for any piece whose box meets this one.
    template <class Holds>
    bool any(const region::Box2& box, Holds holds) const {
        return tree_.any(box, holds);
    }

    // Calls take(index) for every piece whose box meets this one.
    template <class Take>
    void meeting(const region::Box2& box, Take take) const {
        tree_.meeting(box, take);
    }

private:
    std::vector<BoundaryPiece> pieces_;
    region::BoxTree tree_;
};

// A region with its boundary, of which much is asked. The contours must outlive it.
struct BoundedRegion {
    explicit BoundedRegion(Region region) : contours(region), boundary(region) {}

    Region contours;
    Boundary boundary;
};

}  // namespace lyr
