// The middle lines of a region: where the centres of discs run that touch its boundary in two places.
//
// Contract
//  1. Edges are those of the whole medial axis, each between two sites of the boundary: straight, or points on a smooth
//     curve with its tangents, dense enough for cubics between them. Also those that run into corners.
//  2. Edges that meet have an end in common, bit for bit.
//  3. Areas are of what lies between the edge and the two feet of its discs: all edges' together are the region, apart
//     from discs that touch an arc along its length.
//  4. A part of the region that is a disc has no edge; it is one of `discs`.
//  5. `complete` unless numbers are not finite or the areas do not add up.

#pragma once

#include <cstdint>
#include <vector>

#include "kernel/toolpath/inscribed.h"

namespace lyr {

struct MedialPoint {
    Point2 centre;
    Vector2 tangent;  // unit, along the edge
    double radius_mm;
    double area_mm2;  // from the edge's start
};

struct MedialEdge {
    std::vector<MedialPoint> points;
};

struct MedialDisc {
    Point2 centre;
    double radius_mm;
};

struct MedialAxis {
    std::vector<MedialEdge> edges{};
    std::vector<MedialDisc> discs{};
    bool complete = true;
};

// Fast where the region is nowhere much wider than `usual_width_mm`.
MedialAxis medial_axis(Region region, double usual_width_mm);

// Backwards.
MedialEdge reversed(const MedialEdge& edge);

}  // namespace lyr
