// The speed along one path: up to three phases of constant acceleration (gain speed, hold, lose speed).
//
// Contract
//  1. make_profile is the fastest motion over `length_mm` from start to end speed with |acceleration| and
//     speed within bounds. It requires |end^2 - start^2| <= 2 * acceleration * length (to rounding).
//  2. Phases follow one another without gap in distance and time; speed is continuous (relative 1e-12).
//     The first begins at distance 0 and time 0; the last ends at exactly length_mm and duration_s.
//  3. time_at is the inverse of distance_at. Both are evaluated from the slow end of a phase, where the
//     formula does not cancel: an error of the distance d causes a time error of d / speed and no more.
//  4. A dwell is one phase of no length.

#pragma once

#include <array>

namespace lyr::motion {

struct Phase {
    double begin_mm, end_mm;
    double begin_s, end_s;
    double begin_speed_mm_s, end_speed_mm_s;
    double acceleration_mm_s2;  // signed
};

struct Profile {
    static constexpr int kMostPhases = 3;
    std::array<Phase, kMostPhases> phases;
    int phase_count = 0;

    double length_mm() const { return phase_count ? last().end_mm : 0; }
    double duration_s() const { return phase_count ? last().end_s : 0; }
    const Phase& last() const { return phases[static_cast<std::size_t>(phase_count - 1)]; }
};

// Speeds are given squared, as the planner keeps them.
struct ProfileRequest {
    double length_mm;
    double start_speed_sq, end_speed_sq, top_speed_sq;
    double acceleration_mm_s2;
};

Profile make_profile(const ProfileRequest& request);
Profile make_dwell(double duration_s);

double distance_at(const Profile& profile, double time_s);
double speed_at(const Profile& profile, double time_s);
double time_at(const Profile& profile, double distance_mm);

}  // namespace lyr::motion
