// Contract of target/motion/shaper.h, by number. What the shapers leave is measured on a mass on a spring that
// the head's steps pull along, against what the theory of impulses says.

#include "target/motion/shaper.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "timed_machine.h"

namespace lyr::motion {
namespace {

using test::Job;
using test::MotorStep;
using test::Real;
using test::TimedRun;

using std::numbers::pi;

struct Spring {
    double frequency_hz, damping;

    double rate() const { return 2 * pi * frequency_hz; }
    double damped_rate() const { return rate() * std::sqrt(1 - damping * damping); }
};

// The vibration that impulses leave at the time of the last, as a share of what one impulse of the same
// sum leaves then: the textbook's sum of turned and decayed arrows.
double vibration_of(const Taps& taps, std::size_t axis, const Spring& spring) {
    std::int64_t last_ns = taps.front().offset_ns;
    for (const Tap& tap : taps) last_ns = std::min(last_ns, tap.offset_ns);
    std::complex<double> sum;
    for (const Tap& tap : taps) {
        // A later offset is an earlier impulse.
        const double since_s = static_cast<double>(tap.offset_ns - last_ns) * 1e-9;
        sum += tap.weights[axis] * std::exp(-spring.damping * spring.rate() * since_s) *
               std::polar(1.0, -spring.damped_rate() * since_s);
    }
    return std::abs(sum);
}

// The amplitude with which a mass still swings about the head after the last step, from exact solutions
// between the steps of the motor that pulls the spring's other end.
double swing_mm(const TimedRun& timed, const Spring& spring) {
    const double w = spring.rate(), wd = spring.damped_rate(), z = spring.damping;
    double off = 0, speed = 0, last_s = 0;  // of the mass from the head
    for (const MotorStep& step : test::steps_of(timed.run, axis_x)) {
        const double now_s = static_cast<double>(step.time_ns) * 1e-9, t = now_s - last_s;
        const double e = std::exp(-z * w * t), c = std::cos(wd * t), s = std::sin(wd * t);
        const double q = (speed + z * w * off) / wd;
        const double next = e * (off * c + q * s);
        speed = -z * w * next + e * wd * (q * c - off * s);
        off = next - step.direction / timed.run.job.cartesian.steps_per_mm[axis_x];
        last_s = now_s;
    }
    return std::hypot(off, (speed + z * w * off) / wd);
}

// A travel to and a stop, at even speed between two sharp ends: the acceleration takes 0.3 ms.
TimedRun travel(const Taps& taps) {
    Job job;
    job.limits = test::even_limits(300, 3e5);
    job.cartesian.steps_per_mm = {3200, 80, 400, 400};
    job.moves = {{Line{{0, 0, 0}, {41.3, 0, 0}, 0}, 90, 0, 0}};
    Shaping shaping;
    shaping.axes[axis_x] = taps;
    return test::timed_run(job, job.cartesian, shaping);
}

}  // namespace

TEST_CASE("shaper 1: weights are positive and add up to 1, offsets are centred") {
    for (const ShaperKind kind : {ShaperKind::zv, ShaperKind::mzv, ShaperKind::ei})
        for (const double damping : {0.0, 0.05, 0.2, 0.7}) {
            const Taps taps = taps_of(Shaper{kind, 37.3, damping}, axis_y);
            double sum = 0, mean_ns = 0;
            for (const Tap& tap : taps) {
                CHECK(tap.weights[axis_y] > 0);
                CHECK(tap.weights[axis_x] == 0);
                sum += tap.weights[axis_y];
                mean_ns += tap.weights[axis_y] * static_cast<double>(tap.offset_ns);
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-15));
            CHECK(std::abs(mean_ns) < 1);
        }
    CHECK(taps_of(Shaper{}, axis_x).empty());
}

TEST_CASE(
    "shaper 2: ZV and MZV leave nothing at their frequency, EI at most 5 % in a band about it") {
    for (const double damping : {0.0, 0.05, 0.1, 0.2}) {
        const auto left = [&](ShaperKind kind, double share) {
            return vibration_of(taps_of(Shaper{kind, 40, damping}, axis_x), axis_x,
                                {40 * share, damping});
        };
        CHECK(left(ShaperKind::zv, 1) < 1e-6);
        CHECK(left(ShaperKind::mzv, 1) < 1e-6);
        CHECK(left(ShaperKind::ei, 1) <= ei_vibration * 1.001);
        for (const double share : {0.9, 1.1}) {
            CHECK(left(ShaperKind::mzv, share) < left(ShaperKind::zv, share));
            CHECK(left(ShaperKind::ei, share) <= ei_vibration * 1.02);
        }
    }
}

TEST_CASE("shaper 2: what a mass on a spring keeps of a shaped move is what theory says" *
          doctest::test_suite("long")) {
    for (const double damping : {0.0, 0.06})
        for (const double frequency_hz : {36.0, 40.0, 45.0}) {
            const Spring spring{frequency_hz, damping};
            const double plain_mm = swing_mm(travel({}), spring);
            // Both ends excite it; how much depends on where in a period the second one comes.
            REQUIRE(plain_mm > 0.05);
            for (const ShaperKind kind : {ShaperKind::zv, ShaperKind::mzv, ShaperKind::ei}) {
                const Taps taps = taps_of(Shaper{kind, 40, damping}, axis_x);
                const double shaped_mm = swing_mm(travel(taps), spring);
                const double expected_mm = plain_mm * vibration_of(taps, axis_x, spring);
                // Steps of 1/3200 mm shake the mass a little themselves.
                CHECK(std::abs(shaped_mm - expected_mm) < 0.01 * plain_mm + 2e-4);
            }
        }
}

TEST_CASE(
    "shaper 3: the extruder runs ahead by the advance times its speed, and ends where it would") {
    Job job;
    job.cartesian.steps_per_mm[axis_e] = 4000;
    job.moves = {{Line{{0, 0, 0}, {60, 0, 0}, 3}, 60, 0, 0}};
    Shaping shaping;
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    const TimedRun ahead = test::timed_run(job, job.cartesian, shaping);
    const TimedRun plain = test::timed_run(job, job.cartesian, {});
    const auto position_at = [](const TimedRun& timed, double time_s) {
        double mm = 0;
        for (const MotorStep& step : test::steps_of(timed.run, extruder_motor))
            if (static_cast<double>(step.time_ns) < time_s * 1e9) mm += step.direction / 4000.0;
        return mm;
    };
    // 60 mm/s of the head are 3 mm/s of filament.
    for (const double time_s : {0.2, 0.5, 0.8})
        CHECK(position_at(ahead, time_s) - position_at(plain, time_s) ==
              doctest::Approx(0.05 * 3).epsilon(0.005));
    CHECK(ahead.run.counts[extruder_motor] == 12'000);
    CHECK(position_at(ahead, ahead.run.end_ns * 1e-9 + 0.021) == doctest::Approx(3));
    // Filament comes back while the head slows down: the pressure is let off.
    int backwards = 0;
    for (const MotorStep& step : test::steps_of(ahead.run, extruder_motor))
        backwards += step.direction < 0;
    CHECK(backwards > 0);
}

TEST_CASE("shaper 3: retractions and travels are left as they are") {
    Job job;
    job.moves = {{Line{{0, 0, 0}, {0, 0, 0}, -0.8}, 40, 0, 0},
                 {Line{{0, 0, 0}, {20, 0, 0}, 0}, 100, 0, 0},
                 {Line{{20, 0, 0}, {20, 0, 0}, 0.8}, 30, 0, 0}};
    Shaping shaping;
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    const TimedRun ahead = test::timed_run(job, job.cartesian, shaping);
    const TimedRun plain = test::timed_run(job, job.cartesian, {});
    const auto a = test::steps_of(ahead.run, extruder_motor);
    const auto b = test::steps_of(plain.run, extruder_motor);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        REQUIRE(a[i].direction == b[i].direction);
        REQUIRE(std::abs(a[i].time_ns - b[i].time_ns) <= 2);
    }
}

TEST_CASE("shaper 3: the extruder's speed does not jump over junctions") {
    // An extrusion in pieces of different widths, as the planner joins them: within extruder_jump_mm_s.
    Job job;
    job.cartesian.steps_per_mm[axis_e] = 4000;
    for (int i = 0; i < 30; ++i)
        job.moves.push_back(
            {Line{{2.0 * i, 0, 0}, {2.0 * i + 2, 0, 0}, i % 2 ? 0.08 : 0.12}, 80, 0, 0});
    Shaping shaping;
    shaping.extruder = taps_of(PressureAdvance{0.05, 0.04});
    const TimedRun timed = test::timed_run(job, job.cartesian, shaping);
    const test::TimedIdeal ideal(timed);
    // Speed by differences over 0.1 ms; what acceleration may change in 0.1 ms, with the advance.
    double largest_jump = 0, last = 0;
    for (double ns = -2e7; ns < timed.run.end_ns + 2e7; ns += 1e5) {
        const double speed = static_cast<double>(
            (ideal.steps_at_ns(3, ns + 1e5) - ideal.steps_at_ns(3, ns)) / 4000 / Real{1e-4});
        largest_jump = std::max(largest_jump, std::abs(speed - last));
        last = speed;
    }
    const double most_mm_s2 = 3000 * 0.06 * (1 + 2 * 0.05 / 0.04);
    CHECK(largest_jump < (1 + 2 * 0.05 / 0.04) * job.limits.extruder_jump_mm_s + most_mm_s2 * 2e-4);
}

}  // namespace lyr::motion
