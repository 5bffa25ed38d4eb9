// Regions of lines and arcs made larger or smaller by a distance. No arc becomes a polygon.
//
// A region is as in kernel/region: closed contours with the material on the left that wind around no point more than
// once, as those of united() do. A section that crosses itself, where faces of its model overlap a little, is to be
// cleaned() first. docs/algorithms/offset.md says by what method, and why it is right.
//
// Contract
//  1. Outwards (distance > 0): every point within the distance of the region; inwards: every point of it that is
//     farther than that from its boundary. The result's boundary is nowhere farther than `allowed_mm` from there.
//  2. Lines stay lines, arcs stay arcs about the same centre, and a full circle that nothing cuts is a full circle about
//     just that centre. Corners that the boundary goes round are arcs about the corner, or mitred: all of them, or those
//     that come from corners of a given boundary.
//  3. Holes and islands merge and vanish, regions split and are joined. What no disc of diameter `allowed_mm` fits into
//     is left out and counted.
//  4. Contours are closed, have the material on the left and are sorted, as those of kernel/region.
//  5. Every result is checked (offset_check.h). One that fails is made again by a second method, which shares only the
//     region operations with the first, and after the region itself has been cleaned: `second_method` says so. If that
//     fails too, `unresolved` says where and why; the contours are those of the second method then.
//
// Offsets of one region by several distances are best made of the region each, so that errors do not add up.

#pragma once

#include <optional>
#include <vector>

#include "kernel/region/region.h"
#include "kernel/toolpath/boundary.h"

namespace lyr {

enum class Corner { round, mitre };

// Corners of a boundary, seen from a region that lies within it: those whose mitres at that distance end on the boundary, as
// do their sides. Where sides meet that are not beside each other there, as at the mouth of a passage, the mitre's point is in
// mid-air; where a web was cut off, it may be on an edge, but no side goes across.
struct CornersOf {
    const Boundary& boundary;
    double inside_mm;

    // `outwards`: the mean of the unit normals of a corner's two sides.
    bool contains(const Point2& corner, const Vector2& outwards) const;
};

struct OffsetRequest {
    double distance_mm = 0;  // positive: outwards
    double allowed_mm = 0;
    Corner corner = Corner::round;  // where the boundary goes round
    // A mitred corner is at most this many times the distance from the region's corner; a sharper one is round.
    double mitre_limit = 2;
    const CornersOf* mitred = nullptr;  // if given, no other corners are mitred
};

struct OffsetFault {
    enum class Kind {
        input,   // numbers that are not finite
        region,  // an operation on regions could not be settled
        distance,  // a point of the result is nearer to the region's boundary, or farther from it, than it should be
        side,  // a point of the result is inside the region where it should be outside, or the reverse
        nesting,     // contours that do not have the material on their left
        area,        // more or less than any offset can have
        incomplete,  // a point that should be in the result is not
    };
    Kind kind;
    Point2 place = Point2::Zero();
    double off_mm = 0;  // how far the distance is off
};

struct OffsetResult {
    std::vector<Contour> contours{};
    std::size_t slivers = 0;  // left out
    bool second_method = false;
    std::optional<OffsetFault> unresolved{};
};

OffsetResult offset(Region region, const OffsetRequest& request);

// The same; for several offsets of one region, whose boundary is taken apart once.
OffsetResult offset(const BoundedRegion& region, const OffsetRequest& request);

}  // namespace lyr
