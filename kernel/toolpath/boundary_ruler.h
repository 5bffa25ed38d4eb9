// Places on a region's boundary, how far they are from each other along it, and the way between them.
//
// Contract
//  1. A way along the boundary is lines and arcs of the boundary's own lines and circles; its ends are the places'
//     points, bit for bit.
//  2. Ways run along a contour, forwards (material on the left) or backwards.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

struct BoundaryPlace {
    std::uint32_t piece = 0;
    double along_mm = 0;  // from the piece's start
    Point2 point = Point2::Zero();
};

// Of a point on the piece.
BoundaryPlace place_on(std::span<const BoundaryPiece> boundary, std::uint32_t piece,
                       const Point2& point);

class BoundaryRuler {
public:
    // The pieces must outlive it.
    explicit BoundaryRuler(std::span<const BoundaryPiece> pieces);

    std::uint32_t contour(const BoundaryPlace& place) const { return pieces_[place.piece].contour; }
    double contour_length_mm(std::uint32_t contour) const { return contours_[contour].length_mm; }

    // From the contour's start.
    double position_mm(const BoundaryPlace& place) const {
        return piece_start_mm_[place.piece] + place.along_mm;
    }

    // The way between two places of one contour.
    void append_forward(const BoundaryPlace& from, const BoundaryPlace& to,
                        std::vector<Segment>& way) const;
    void append_backward(const BoundaryPlace& from, const BoundaryPlace& to,
                         std::vector<Segment>& way) const;

private:
    struct ContourPieces {
        std::uint32_t first = 0, last = 0;  // [first, last)
        double length_mm = 0;
    };

    std::uint32_t next(std::uint32_t piece) const;

    std::span<const BoundaryPiece> pieces_;
    std::vector<double> piece_start_mm_;
    std::vector<ContourPieces> contours_;
};

}  // namespace lyr
