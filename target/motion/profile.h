// How fast a path is walked: time as a function of distance and back. Phases of even acceleration or
// even jerk, one after the other; a trapezoid has three of them, an S-curve seven.
//
// Contract
//  1. distance_at(time_at(s)) is s, time_at(0) is 0 and time_at(length) is the duration, up to
//     rounding.
//  2. Distance and speed are continuous over phases; distance never falls.
//  3. trapezoid() begins and ends with the speeds given, never exceeds `top_speed` and is the
//     fastest such profile with at most this acceleration.
//  4. So does s_curve(), and its acceleration is 0 at both ends, never exceeds the one given and never
//     changes faster than the jerk. It is the fastest of those that rise to one top speed and fall from it.
//  5. reachable_mm_s() is the largest speed that such a rise gets to over a length.
//  6. trapezoid_peak_mm_s() and s_curve_peak_mm_s() are the highest speeds of these profiles.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lyr::motion {

struct Phase {
    double distance_mm = 0;  // of its begin, along the path
    double time_s = 0;       // of its begin, since the begin of the move
    double speed_mm_s = 0;   // at its begin
    double acceleration_mm_s2 = 0;
    double jerk_mm_s3 = 0;
};

struct Profile {
    static constexpr std::size_t phase_count = 7;
    std::array<Phase, phase_count> phases;
    double length_mm = 0;
    double duration_s = 0;
    double end_speed_mm_s = 0;

    double time_at(double distance_mm) const;
    double distance_at(double time_s) const;
    double speed_at(double time_s) const;
};

// When a phase without jerk gets to a distance: 2 s / (v + w) with v, w the speeds at both ends of the way,
// which loses no digits for any acceleration, none included. Before its begin it is the phase's
// begin.
inline double time_in_phase(const Phase& phase, double distance_mm) {
    const double way_mm = distance_mm - phase.distance_mm;
    if (!(way_mm > 0)) return phase.time_s;
    const double v = phase.speed_mm_s;
    const double w = std::sqrt(std::max(0.0, v * v + 2 * phase.acceleration_mm_s2 * way_mm));
    return phase.time_s + 2 * way_mm / (v + w);
}

// The speeds at the ends must be reachable from each other over the length.
double trapezoid_peak_mm_s(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                           double top_speed_mm_s, double acceleration_mm_s2);
Profile trapezoid(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                  double top_speed_mm_s, double acceleration_mm_s2);

struct RampLimits {
    double acceleration_mm_s2 = 0;
    double jerk_mm_s3 = 0;
};

double reachable_mm_s(double speed_mm_s, double length_mm, const RampLimits& limits);

double s_curve_peak_mm_s(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                         double top_speed_mm_s, const RampLimits& limits);
Profile s_curve(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                double top_speed_mm_s, const RampLimits& limits);

}  // namespace lyr::motion
