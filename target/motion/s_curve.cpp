// A rise from v to w without acceleration at its ends is symmetric in time: jerk up, even, jerk down. So it
// covers (v + w) / 2 times its duration, whatever its shape, and the duration is a function of w - v alone:
//   2 sqrt((w - v) / j)     where the acceleration stays below its limit a,
//   (w - v) / a + a / j     where it reaches it.

#include <algorithm>
#include <cmath>

#include "target/motion/profile.h"

namespace lyr::motion {
namespace {

// Of Newton's steps from above on a convex function, and of halvings of a range of speeds: both are at the
// rounding long before.
constexpr int most_looks = 60;

struct Ramp {
    double duration_s = 0, jerk_s = 0;  // the latter of each of the two ends
};

Ramp ramp_over(double change_mm_s, const RampLimits& limits) {
    const double a = limits.acceleration_mm_s2, j = limits.jerk_mm_s3;
    if (change_mm_s * j >= a * a) return {change_mm_s / a + a / j, a / j};
    const double jerk_s = std::sqrt(change_mm_s / j);
    return {2 * jerk_s, jerk_s};
}

double length_mm(double from_mm_s, double to_mm_s, const RampLimits& limits) {
    return (from_mm_s + to_mm_s) / 2 * ramp_over(std::abs(to_mm_s - from_mm_s), limits).duration_s;
}

// Appends the three phases from one speed to another over a length; returns their duration. A length that
// is shorter by rounding than it should be makes them a little steeper.
class Drawing {
public:
    explicit Drawing(Profile& profile) : profile_(profile) {}

    void ramp(double from_mm_s, double to_mm_s, double way_mm, const RampLimits& limits) {
        const double change_mm_s = to_mm_s - from_mm_s;
        const Ramp ideal = ramp_over(std::abs(change_mm_s), limits);
        const double sum_mm_s = from_mm_s + to_mm_s;
        if (!(way_mm > 0) || !(ideal.duration_s > 0)) {
            for (int i = 0; i < 3; ++i) phase(0, to_mm_s, 0, 0);
            return;
        }
        const double duration_s = 2 * way_mm / sum_mm_s;
        const double jerk_s = ideal.jerk_s * duration_s / ideal.duration_s;
        const double peak_mm_s2 = change_mm_s / (duration_s - jerk_s);
        const double jerk_mm_s3 = peak_mm_s2 / jerk_s;
        const double gained_mm_s = peak_mm_s2 * jerk_s / 2;
        phase(jerk_s, from_mm_s, 0, jerk_mm_s3);
        phase(std::max(0.0, duration_s - 2 * jerk_s), from_mm_s + gained_mm_s, peak_mm_s2, 0);
        phase(jerk_s, to_mm_s - gained_mm_s, peak_mm_s2, -jerk_mm_s3);
    }
    void even(double speed_mm_s, double way_mm) {
        phase(way_mm > 0 ? way_mm / speed_mm_s : 0, speed_mm_s, 0, 0);
    }
    double time_s() const { return time_s_; }

private:
    void phase(double duration_s, double speed, double acceleration, double jerk) {
        profile_.phases[count_++] = {distance_mm_, time_s_, speed, acceleration, jerk};
        distance_mm_ +=
            duration_s * (speed + duration_s * (acceleration / 2 + duration_s * jerk / 6));
        time_s_ += duration_s;
    }

    Profile& profile_;
    std::size_t count_ = 0;
    double distance_mm_ = 0, time_s_ = 0;
};

}  // namespace

double reachable_mm_s(double speed_mm_s, double length_mm, const RampLimits& limits) {
    const double v = speed_mm_s, a = limits.acceleration_mm_s2, j = limits.jerk_mm_s3;
    // The limit reached: (2 v + d) (d + a^2 / j) = 2 a s for the change d.
    const double b = a * a / j, half = (2 * v + b) / 2, c = 2 * (a * length_mm - v * b);
    const double root = std::sqrt(std::max(0.0, half * half + c));
    const double change = c / (half + root);
    if (change >= b) return v + change;
    // Below: y (y^2 + 2 v) = s sqrt(j) with y^2 = d, from above.
    const double target = length_mm * std::sqrt(j);
    double y = std::cbrt(target);
    if (v > 0) y = std::min(y, target / (2 * v));
    for (int look = 0; look < most_looks; ++look) {
        const double next = y - (y * (y * y + 2 * v) - target) / (3 * y * y + 2 * v);
        if (!(next < y)) break;
        y = next;
    }
    return v + y * y;
}

// The highest speed from which both ramps fit the length.
double s_curve_peak_mm_s(double way_mm, double v, double w, double top, const RampLimits& limits) {
    const auto fits = [&](double peak) {
        return length_mm(v, peak, limits) + length_mm(w, peak, limits) <= way_mm;
    };
    double low = std::max(v, w), high = std::max(top, low);
    if (fits(high)) return high;
    for (int look = 0; look < most_looks; ++look) {
        const double middle = low + (high - low) / 2;
        (fits(middle) ? low : high) = middle;
    }
    return low;
}

Profile s_curve(double way_mm, double start_speed_mm_s, double end_speed_mm_s,
                double top_speed_mm_s, const RampLimits& limits) {
    const double v = start_speed_mm_s, w = end_speed_mm_s;
    const double peak = s_curve_peak_mm_s(way_mm, v, w, top_speed_mm_s, limits);
    const double up_mm = std::min(way_mm, length_mm(v, peak, limits));
    const double down_mm = std::min(way_mm - up_mm, length_mm(w, peak, limits));
    Profile profile;
    Drawing drawing(profile);
    drawing.ramp(v, peak, up_mm, limits);
    drawing.even(peak, std::max(0.0, way_mm - up_mm - down_mm));
    drawing.ramp(peak, w, down_mm, limits);
    profile.length_mm = way_mm;
    profile.duration_s = drawing.time_s();
    profile.end_speed_mm_s = w;
    return profile;
}

}  // namespace lyr::motion
