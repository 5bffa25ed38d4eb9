// How fast a path is walked: time as a function of distance and back. Phases of even acceleration, one
// after the other; a trapezoid has three of them.
//
// Contract
//  1. distance_at(time_at(s)) is s, time_at(0) is 0 and time_at(length) is the duration, up to rounding.
//  2. Distance and speed are continuous over phases; distance never falls.
//  3. trapezoid() begins and ends with the speeds given, never exceeds `top_speed` and is the fastest
//     such profile with at most this acceleration.

#pragma once

#include <array>
#include <cstddef>

namespace lyr::motion {

struct Phase {
    double distance_mm = 0;  // of its begin, along the path
    double time_s = 0;       // of its begin, since the begin of the move
    double speed_mm_s = 0;   // at its begin
    double acceleration_mm_s2 = 0;
};

struct Profile {
    static constexpr std::size_t phase_count = 3;
    std::array<Phase, phase_count> phases;
    double length_mm = 0;
    double duration_s = 0;
    double end_speed_mm_s = 0;

    double time_at(double distance_mm) const;
    double distance_at(double time_s) const;
    double speed_at(double time_s) const;
};

// Of a phase, at a distance not before its begin.
double time_in_phase(const Phase& phase, double distance_mm);

// The speeds at the ends must be reachable from each other over the length.
Profile trapezoid(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                  double top_speed_mm_s, double acceleration_mm_s2);

}  // namespace lyr::motion
