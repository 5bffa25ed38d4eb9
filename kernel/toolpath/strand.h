// What a nozzle lays down in one go: a path of lines and arcs, and its width.
//
// Contract
//  1. The path is the middle of the strand. It is closed if it is a full circle or ends where it starts, bit for bit.
//  2. Widths are those of the rounded rectangle that a strand has as its cross-section, from flank to flank.

#pragma once

#include <vector>

#include "kernel/contour/contour.h"

namespace lyr {

struct Strand {
    Contour path;
    double width_mm = 0;
    std::vector<double> widths_mm{};  // where the width varies: one a segment, in place of width_mm
};

inline bool is_closed(const Strand& strand) {
    const auto* path = std::get_if<Path>(&strand.path);
    return !path || (!path->segments.empty() && path->segments.back().end == path->start);
}

// Of its widths along its way, without what is around its ends.
inline double flat_area_mm2(const Strand& strand) {
    if (strand.widths_mm.empty()) return length_mm(strand.path) * strand.width_mm;
    const Path& path = std::get<Path>(strand.path);
    double area = 0;
    Point2 from = path.start;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        area += length_mm(from, path.segments[i]) * strand.widths_mm[i];
        from = path.segments[i].end;
    }
    return area;
}

}  // namespace lyr
