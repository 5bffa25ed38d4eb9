// The one place where lengths and angles are called equal.
//
// The user's tolerance bounds the distance between the printed contour and the exact section. It is split:
//   trace     an eighth        points of a traced curve off the exact one, arcs joined into one
//   fit       31 parts of 64   fitted arcs off the curve's points
//   unite     a sixteenth      contours moved to each other where solids meet
//   quantise  21 parts of 64   coordinates rounded to the file's quantum
// Exact lines and arcs have no fit error; their quantisation may use that share too.

#pragma once

namespace lyr {

struct Tolerance {
    double total_mm = 0.005;

    constexpr double trace_mm() const { return total_mm / 8; }
    constexpr double fit_mm() const { return total_mm * 31 / 64; }
    constexpr double unite_mm() const { return total_mm / 16; }
    constexpr double quantise_mm() const { return total_mm * 21 / 64; }
};

// Heights and points closer than this are one: the resolution of the model's own coordinates. STEP files
// carry 7 to 16 digits over up to a metre; ten times finer than the finest .lyr quantum (1 nm..1 µm) matters
// to nobody, ten times coarser would merge real features of micro-machined parts.
inline constexpr double resolution_mm = 1e-7;

// A plane is not cut closer than this to a height where the section changes its topology, but this far above or
// below it: a hundred times resolution_mm, so that round-off in edges cannot exchange what the topology orders,
// and a hundredth of a micrometre, which no printer can tell from the height asked for.
inline constexpr double level_clearance_mm = 1e-5;

// Directions closer than this are parallel: resolution_mm seen from a metre away.
inline constexpr double angular_resolution_rad = 1e-10;

}  // namespace lyr
