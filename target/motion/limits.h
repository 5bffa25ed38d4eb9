// What the machine can do, and what that means for one move and for the corner between two.
//
// Contract
//  1. While a move is walked within its MoveLimits, no axis exceeds its speed or its acceleration,
//     in whatever direction an arc points on its way: its tangential and its centripetal
//     acceleration are added up as vectors.
//  2. The acceleration that a move asks for bounds its tangential and its centripetal acceleration
//     each.
//  3. corner_speed_mm_s() is the speed at which the axes, accelerating along the corner's bisector,
//     go round a circle that touches both tangents and passes the corner within the junction
//     deviation, or, if that is smaller, one that touches no further away than half of the shorter
//     move (a curve given as many short lines). Where the tangents agree there is no limit but the
//     moves' own.
//  4. Over a crooked bed z moves too: by the slope for each mm of the path, faster and slower with the bed's twist and
//     with the arc's turn. That and z's own motion keep the limits of z, with half of its acceleration for changes of
//     speed and half for the rest. At the edges of cells, and where the bed begins and ends to fade, its
//     speed jumps by no more than bed_jump_mm_s.
//  5. The extruder's speed does not jump by more than extruder_jump_mm_s at a corner. Between a
//     move of the extruder alone and any other the machine stops.

#pragma once

#include <array>
#include <cstdint>

#include "base/diagnostic.h"
#include "target/motion/bed_mesh.h"
#include "target/motion/path.h"

namespace lyr::motion {

struct AxisLimits {
    double speed_mm_s = 0;
    double acceleration_mm_s2 = 0;
};

struct Limits {
    std::array<AxisLimits, axis_count> axes;
    double junction_deviation_mm = 0.02;
    double extruder_jump_mm_s = 1;
    double jerk_mm_s3 = 0;  // along the path; 0: no limit
    // Of every way from one slow place to the next this share is gone at an even speed; below 1.
    double minimum_cruise_ratio = 0;
    BedShape bed{};
    double bed_jump_mm_s = 1;
};

struct Move {
    Path path;
    double speed_mm_s = 0;
    double acceleration_mm_s2 = 0;  // 0: what the axes can do
    std::uint32_t tag = 0;          // the caller's own; comes back with the plan
};

// Of a move by itself.
struct MoveLimits {
    double speed_mm_s = 0;
    double acceleration_mm_s2 = 0;  // along the path
};

// All limits are positive (the junction deviation and the ratio may be 0) and at most 1e9; otherwise what is not.
Status check(const Limits& limits);

MoveLimits limits_of(const Move& move, const Limits& limits);

// Infinite where nothing limits it.
double corner_speed_mm_s(const Move& before, const Move& after, const Limits& limits);

}  // namespace lyr::motion
