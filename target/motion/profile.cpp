#include "target/motion/profile.h"

#include <algorithm>
#include <cmath>

namespace lyr::motion {
namespace {

// Of a phase that covers the distance, from the speeds at its ends.
double duration_s(double distance_mm, double from_mm_s, double to_mm_s) {
    return distance_mm > 0 ? 2 * distance_mm / (from_mm_s + to_mm_s) : 0;
}

// From one speed to a higher one.
double ramp_mm(double low_mm_s, double high_mm_s, double acceleration_mm_s2) {
    return (high_mm_s - low_mm_s) * (high_mm_s + low_mm_s) / (2 * acceleration_mm_s2);
}

// The last phase that has begun.
template <class Begun>
const Phase& phase_where(const Profile& profile, Begun begun) {
    std::size_t index = Profile::phase_count - 1;
    while (index > 0 && !begun(profile.phases[index])) --index;
    return profile.phases[index];
}

const Phase& phase_at_time(const Profile& profile, double time_s) {
    return phase_where(profile, [=](const Phase& phase) { return phase.time_s <= time_s; });
}

struct End {
    double length_mm, duration_s, speed_mm_s;
};

// What is left of the phases begins, and ends, at the end.
void finish(Profile& profile, std::size_t used, const End& end) {
    for (std::size_t i = used; i < Profile::phase_count; ++i)
        profile.phases[i] = {end.length_mm, end.duration_s, end.speed_mm_s};
    profile.length_mm = end.length_mm;
    profile.duration_s = end.duration_s;
    profile.end_speed_mm_s = end.speed_mm_s;
}

}  // namespace

double Profile::time_at(double distance_mm) const {
    const Phase& phase = phase_where(
        *this, [=](const Phase& candidate) { return candidate.distance_mm <= distance_mm; });
    if (phase.jerk_mm_s3 == 0) return time_in_phase(phase, distance_mm);
    const std::size_t next = static_cast<std::size_t>(&phase - phases.data()) + 1;
    double low_s = phase.time_s, high_s = next < phase_count ? phases[next].time_s : duration_s;
    while (true) {
        const double middle_s = low_s + (high_s - low_s) / 2;
        if (!(middle_s > low_s && middle_s < high_s)) return high_s;
        (distance_at(middle_s) < distance_mm ? low_s : high_s) = middle_s;
    }
}

double Profile::distance_at(double time_s) const {
    const Phase& phase = phase_at_time(*this, time_s);
    const double t = time_s - phase.time_s;
    return phase.distance_mm +
           t * (phase.speed_mm_s + t * (phase.acceleration_mm_s2 / 2 + t * phase.jerk_mm_s3 / 6));
}

double Profile::speed_at(double time_s) const {
    const Phase& phase = phase_at_time(*this, time_s);
    const double t = time_s - phase.time_s;
    return phase.speed_mm_s + t * (phase.acceleration_mm_s2 + t * phase.jerk_mm_s3 / 2);
}

double trapezoid_peak_mm_s(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                           double top_speed_mm_s, double acceleration_mm_s2) {
    const double v = start_speed_mm_s, w = end_speed_mm_s;
    // Where speeding up meets slowing down, if the top is not reached before.
    const double meeting_mm_s = std::sqrt((v * v + w * w) / 2 + acceleration_mm_s2 * length_mm);
    return std::max({std::min(meeting_mm_s, top_speed_mm_s), v, w});
}

Profile trapezoid(double length_mm, double start_speed_mm_s, double end_speed_mm_s,
                  double top_speed_mm_s, double acceleration_mm_s2) {
    const double v = start_speed_mm_s, w = end_speed_mm_s;
    const double peak_mm_s =
        trapezoid_peak_mm_s(length_mm, v, w, top_speed_mm_s, acceleration_mm_s2);
    const double up_mm = std::min(length_mm, ramp_mm(v, peak_mm_s, acceleration_mm_s2));
    const double down_mm = std::min(length_mm - up_mm, ramp_mm(w, peak_mm_s, acceleration_mm_s2));
    const double even_mm = std::max(0.0, length_mm - up_mm - down_mm);
    const double up_s = duration_s(up_mm, v, peak_mm_s);
    const double even_s = duration_s(even_mm, peak_mm_s, peak_mm_s);

    Profile profile;
    profile.phases[0] = {0, 0, v, acceleration_mm_s2};
    profile.phases[1] = {up_mm, up_s, peak_mm_s, 0};
    profile.phases[2] = {up_mm + even_mm, up_s + even_s, peak_mm_s, -acceleration_mm_s2};
    finish(profile, 3, {length_mm, up_s + even_s + duration_s(down_mm, peak_mm_s, w), w});
    return profile;
}

}  // namespace lyr::motion
