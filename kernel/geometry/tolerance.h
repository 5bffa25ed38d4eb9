// The one place where lengths and angles are called equal.
//
// The user's tolerance bounds the distance between the printed contour and the exact section. It is split:
//   trace     an eighth   points of a traced curve off the exact one
//   fit       half        arcs off the points' curve
//   quantise  an eighth   coordinates rounded to the file's quantum
// What remains (a quarter) covers a model whose edges lie off its surfaces by round-off.

#pragma once

namespace lyr {

struct Tolerance {
    double total_mm = 0.005;

    constexpr double trace_mm() const { return total_mm / 8; }
    constexpr double fit_mm() const { return total_mm / 2; }
    constexpr double quantise_mm() const { return total_mm / 8; }
};

// Heights and points closer than this are one: the resolution of the model's own coordinates. STEP files
// carry 7 to 16 digits over up to a metre; ten times finer than the finest .lyr quantum (1 nm..1 µm) matters
// to nobody, ten times coarser would merge real features of micro-machined parts.
inline constexpr double resolution_mm = 1e-7;

// Directions closer than this are parallel: resolution_mm seen from a metre away.
inline constexpr double angular_resolution_rad = 1e-10;

}  // namespace lyr
