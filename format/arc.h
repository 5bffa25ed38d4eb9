// The circle that an arc record stands for. An arc is stored by its end points and its sagitta s,
// the signed height of its middle over the chord c: with t = tan(sweep / 4) = 2 s / c, radius and
// centre follow by division alone, and stay exact where a centre would be far away.
//
// Contract
//  1. |start - centre| = |end - centre| = radius up to rounding (a few ulps of the radius).
//  2. sweep has the sign of the sagitta and is below 2 pi.

#pragma once

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "format/operation.h"

namespace lyr::format {

struct ArcShape {
    double center_x = 0, center_y = 0, radius = 0;  // in the unit of the input
    double start_angle_rad = 0;
    double sweep_rad = 0;  // signed

    double length() const { return radius * std::abs(sweep_rad); }
};

// The chord must not be 0 nor the sagitta.
inline ArcShape arc_shape(double from_x, double from_y, double to_x, double to_y, double sagitta) {
    const double dx = to_x - from_x, dy = to_y - from_y;
    const double chord = std::hypot(dx, dy);
    const double t = 2 * sagitta / chord;
    // From the chord's middle to the centre, along the left normal, in chords: (1 - t^2) / (4 t).
    const double rise = (1 - t * t) / (4 * t);
    ArcShape arc;
    arc.center_x = from_x + dx / 2 - dy * rise;
    arc.center_y = from_y + dy / 2 + dx * rise;
    arc.radius = chord * (1 + t * t) / (4 * std::abs(t));
    arc.start_angle_rad = std::atan2(from_y - arc.center_y, from_x - arc.center_x);
    arc.sweep_rad = 4 * std::atan(t);
    return arc;
}

// In quanta.
inline ArcShape arc_shape(const Arc& arc) {
    return arc_shape(static_cast<double>(arc.from.x), static_cast<double>(arc.from.y),
                     static_cast<double>(arc.to.x), static_cast<double>(arc.to.y),
                     static_cast<double>(arc.sagitta));
}

// The widest arc: tan(3/2 pi / 4) = 1 + sqrt(2). A wider one has ends so near each other that
// rounding them would turn it about.
inline constexpr double widest_sagitta_per_chord = (1 + std::numbers::sqrt2) / 2;
// What is far beyond that (1.207 chords) is no arc of a writer's: 4 |s| must be at most 5 chords. The
// squares have up to 74 bits; without the low 16 of them they decide all but what is so near that
// the low 64 do.
inline bool is_arc(const Point& from, const Point& to, std::int64_t sagitta) {
    constexpr std::int64_t largest_sagitta = std::int64_t{1} << 33;
    if (sagitta < -largest_sagitta || sagitta > largest_sagitta) return false;
    // Most are far from that.
    if (std::abs(sagitta) <= std::abs(to.x - from.x) ||
        std::abs(sagitta) <= std::abs(to.y - from.y))
        return true;
    const auto scaled = [](std::uint64_t factor, std::int64_t value) {
        return factor * static_cast<std::uint64_t>(value < 0 ? -value : value);
    };
    const std::uint64_t s = scaled(4, sagitta), dx = scaled(5, to.x - from.x),
                        dy = scaled(5, to.y - from.y), over = s * s - dx * dx - dy * dy;
    const auto coarse = [](std::uint64_t value) {
        return static_cast<std::int64_t>((value >> 8) * (value >> 8));
    };
    constexpr std::int64_t near = std::int64_t{1} << 40;
    const std::int64_t coarsely_over = coarse(s) - coarse(dx) - coarse(dy);
    if (coarsely_over < -near || coarsely_over > near) return coarsely_over < 0;
    return over == 0 || over >> 63 != 0;
}

}  // namespace lyr::format
