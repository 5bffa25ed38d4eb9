#include "target/motion/smooth.h"

#include <algorithm>
#include <limits>

namespace lyr::motion {
namespace {

// Factors of the series of sin(a) / a and (1 - cos(a)) / a^2 by a^2. For |a| <= 0.8 the first ones left
// out, 0.8^18 / 19! and 0.8^18 / 20!, are below the rounding of the sum.
constexpr std::array<double, 9> sine_series{1.0 / 1.,
                                            -1.0 / 6.,
                                            1.0 / 120.,
                                            -1.0 / 5040.,
                                            1.0 / 362880.,
                                            -1.0 / 39916800.,
                                            1.0 / 6227020800.,
                                            -1.0 / 1307674368000.,
                                            1.0 / 355687428096000.};
constexpr std::array<double, 9> versine_series{1.0 / 2.,
                                               -1.0 / 24.,
                                               1.0 / 720.,
                                               -1.0 / 40320.,
                                               1.0 / 3628800.,
                                               -1.0 / 479001600.,
                                               1.0 / 87178291200.,
                                               -1.0 / 20922789888000.,
                                               1.0 / 6402373705728000.};

// By Estrin's scheme: its terms do not wait for each other, as Horner's do.
double sum(const std::array<double, 9>& c, double q) {
    const double q2 = q * q, q4 = q2 * q2;
    const double low = (c[0] + c[1] * q) + (c[2] + c[3] * q) * q2;
    const double high = (c[4] + c[5] * q) + (c[6] + c[7] * q) * q2;
    return low + (high + c[8] * q4) * q4;
}

// A turn at a time: its way so far, the angle's derivatives, each by its factorial, and the turn seen from there.
struct TurnState {
    double way, rate, half_acceleration, sixth_jerk;
    double ahead, inward;
};

TurnState state_of(const Turn& turn, double time) {
    const TurnAngle& a = turn.angle;
    if (time == 0) return {0, a.rate, a.half_acceleration, a.sixth_jerk, turn.ahead, turn.inward};
    const double angle = time * (a.rate + time * (a.half_acceleration + time * a.sixth_jerk));
    const auto [sine, versine] = Smooth::turned(angle);
    const double cosine = 1 - versine;
    return {turn.ahead * sine + turn.inward * versine,
            a.rate + time * (2 * a.half_acceleration + time * 3 * a.sixth_jerk),
            a.half_acceleration + 3 * a.sixth_jerk * time,
            a.sixth_jerk,
            turn.ahead * cosine + turn.inward * sine,
            turn.inward * cosine - turn.ahead * sine};
}

}  // namespace

SineVersine Smooth::turned(double angle) {
    const double q = angle * angle;
    return {angle * sum(sine_series, q), q * sum(versine_series, q)};
}

void Smooth::add(const Turn& turn, double time, Sample& sample) {
    const TurnState at = state_of(turn, time);
    sample.position += at.way;
    sample.speed += at.ahead * at.rate;
    sample.acceleration += at.ahead * 2 * at.half_acceleration + at.inward * at.rate * at.rate;
}

// Of ahead sin(d) + inward (1 - cos(d)), where d is the angle since then: both up to its fifth power, each sorted by
// powers of the time.
void Smooth::add(const Turn& turn, double time, Series& series) {
    const TurnState at = state_of(turn, time);
    const double a1 = at.rate, a2 = at.half_acceleration, a3 = at.sixth_jerk;
    const double a11 = a1 * a1, a12 = a1 * a2, a13 = a1 * a3;
    series[0] += at.way;
    series[1] += at.ahead * a1;
    series[2] += at.ahead * a2 + at.inward * (a11 * (1. / 2));
    series[3] += at.ahead * (a3 - a11 * a1 * (1. / 6)) + at.inward * a12;
    series[4] += at.inward * (a2 * a2 * (1. / 2) + a13 - a11 * a11 * (1. / 24)) -
                 at.ahead * (a11 * a2 * (1. / 2));
    series[5] += at.ahead * (a11 * a11 * a1 * (1. / 120) - (a12 * a2 + a13 * a1) * (1. / 2)) +
                 at.inward * (a2 * a3 - a11 * a12 * (1. / 6));
}

// Of an angle that does not turn back, the rate is largest at one of the ends, unless its acceleration
// changes sign between them; the sum of sizes covers that. The derivatives are Bell's polynomials of the angle's three.
Bounds Smooth::bounds(double time) const {
    Bounds bounds{{0, std::abs(c_[1]) + time * (2 * std::abs(c_[2]) + time * 3 * std::abs(c_[3])),
                   std::abs(c_[2]) + 3 * std::abs(c_[3]) * time, std::abs(c_[3])},
                  6 * c_[3],
                  6 * c_[3]};
    for (std::size_t i = 0; i < turn_count_; ++i) {
        const Turn& turn = turns_[i];
        const double size = std::sqrt(turn.ahead * turn.ahead + turn.inward * turn.inward);
        const double half = std::abs(turn.angle.half_acceleration);
        const double sixth = std::abs(turn.angle.sixth_jerk);
        const double end_rate = turn.angle.rate + time * (2 * turn.angle.half_acceleration +
                                                          time * 3 * turn.angle.sixth_jerk);
        const double r =
            std::max(std::abs(turn.angle.rate), std::abs(end_rate)) + time * time * 3 * sixth;
        const double a = 2 * half + 6 * sixth * time, j = 6 * sixth;
        const double r2 = r * r, a2 = a * a, jerk = size * (r2 * r + 3 * r * a + j);
        bounds.least_jerk -= jerk;
        bounds.most_jerk += jerk;
        motion::add(bounds.sizes,
                    Sizes{0, size * r, size * (r2 + a) * (1. / 2), jerk * (1. / 6),
                          size * (r2 * (r2 + 6 * a) + 3 * a2 + 4 * r * j) * (1. / 24),
                          size * (r * (r2 * (r2 + 10 * a) + 15 * a2 + 10 * r * j) + 10 * a * j) *
                              (1. / 120),
                          size *
                              (r2 * (r2 * (r2 + 15 * a) + 20 * r * j + 45 * a2) + 60 * r * a * j +
                               15 * a * a2 + 10 * j * j) *
                              (1. / 720)});
    }
    return bounds;
}

// From each look on, the acceleration's bound says how long neither bound can be reached. Close to a bound that is
// Newton's step, so that a few looks suffice.
double Smooth::leaves(double low, double high, double nearly, double time) const {
    constexpr int most_looks = 50;
    const double acceleration = 2 * bounds(time).sizes[2];
    const auto reach_s = [acceleration](double way, double speed) {
        if (std::isinf(way)) return way;
        const double root = speed + std::sqrt(speed * speed + 2 * acceleration * way);
        return root > 0 ? 2 * way / root : std::numeric_limits<double>::infinity();
    };
    double at_s = 0;
    for (int look = 0; look < most_looks && at_s < time; ++look) {
        const Sample sample = at(at_s);
        const double up = high - sample.position, down = sample.position - low;
        if (std::min(up, down) <= nearly) break;
        at_s += std::min(reach_s(up, sample.speed), reach_s(down, -sample.speed));
    }
    return std::min(at_s, time);
}

}  // namespace lyr::motion
