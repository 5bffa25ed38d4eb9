// Closed contours of lines and arcs.
//
// Contract
//  1. A contour has its material on the left: outer boundaries run counter-clockwise, holes clockwise.
//  2. A Path is closed: its last segment ends at `start`, the same number bit for bit.
//  3. area() is signed and exact for lines and arcs: the sum over a region's contours is the region's area.
//  4. simplified() joins what belongs together: arcs of one circle become one arc or one full circle, lines in
//     line become one line. No point of the result is farther than `allowed_mm` from the contour. A path that
//     encloses nothing (all its points within resolution_mm) becomes none.

#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "kernel/contour/arc.h"

namespace lyr {

struct Path {
    Point2 start;
    std::vector<Segment> segments;
    friend bool operator==(const Path&, const Path&) = default;
};

struct FullCircle {
    Point2 centre;
    double radius_mm;
    bool counter_clockwise;
    friend bool operator==(const FullCircle&, const FullCircle&) = default;
};

using Contour = std::variant<Path, FullCircle>;

// Of a full circle, where it is farthest in x.
Point2 start_of(const Contour& contour);

double area_mm2(const Contour& contour);
double length_mm(const Contour& contour);

// A full circle counts as one arc.
struct SegmentCount {
    std::size_t lines = 0, arcs = 0;
};
SegmentCount count(const Contour& contour);

std::optional<Contour> simplified(Path path, double allowed_mm);

}  // namespace lyr
