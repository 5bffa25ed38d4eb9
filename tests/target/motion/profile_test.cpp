#include "target/motion/profile.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace lyr::motion {

TEST_CASE("profile 3: a trapezoid from rest to rest takes v/a + s/v") {
    const Profile profile = trapezoid(100, 0, 0, 50, 1000);
    CHECK(profile.duration_s == doctest::Approx(50.0 / 1000 + 100.0 / 50).epsilon(1e-15));
    CHECK(profile.speed_at(0.05) == doctest::Approx(50));
    CHECK(profile.speed_at(1) == 50);
    CHECK(profile.distance_at(profile.duration_s / 2) == doctest::Approx(50).epsilon(1e-15));
}

TEST_CASE("profile 3: a triangle from rest to rest takes 2 sqrt(s/a)") {
    const Profile profile = trapezoid(1, 0, 0, 500, 1000);
    CHECK(profile.duration_s == doctest::Approx(2 * std::sqrt(1.0 / 1000)).epsilon(1e-15));
    CHECK(profile.speed_at(profile.duration_s / 2) ==
          doctest::Approx(std::sqrt(1000.0)).epsilon(1e-13));
}

TEST_CASE("profile 3: speeding up all the way takes (w - v) / a") {
    const double v = 10, w = std::sqrt(10.0 * 10 + 2 * 1000 * 3);
    for (const bool up : {true, false}) {
        const Profile profile = trapezoid(3, up ? v : w, up ? w : v, 500, 1000);
        CHECK(profile.duration_s == doctest::Approx((w - v) / 1000).epsilon(1e-13));
    }
}

TEST_CASE("profile 1, 2, 3: distance and time are inverse, speed is continuous and limited") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const double length = std::pow(10, 6 * share(random) - 4), top = 1 + 300 * share(random);
        const double a = 100 + 5000 * share(random), v = top * share(random);
        const double far = std::min(top, std::sqrt(v * v + 2 * a * length));
        const double near = std::sqrt(std::max(0.0, v * v - 2 * a * length));
        const double w = near + (far - near) * share(random);
        const Profile profile = trapezoid(length, v, w, top, a);
        REQUIRE(profile.time_at(0) == 0);
        REQUIRE(profile.speed_at(0) == doctest::Approx(v));
        REQUIRE(profile.time_at(length) == doctest::Approx(profile.duration_s).epsilon(1e-12));
        REQUIRE(profile.distance_at(profile.duration_s) == doctest::Approx(length).epsilon(1e-12));
        REQUIRE(std::abs(profile.speed_at(profile.duration_s) - w) < 1e-9 * top);
        double last = 0;
        for (int k = 1; k <= 20; ++k) {
            const double time = profile.duration_s * k / 20, distance = profile.distance_at(time);
            REQUIRE(distance >= last);
            REQUIRE(profile.speed_at(time) <= top * (1 + 1e-15));
            REQUIRE(profile.time_at(distance) == doctest::Approx(time).epsilon(1e-10));
            last = distance;
        }
    }
}

TEST_CASE("profile 3: no faster one exists, for some phase is at the top or none is even") {
    const Profile even = trapezoid(10, 3, 4, 20, 100), peaked = trapezoid(1, 3, 4, 20, 100);
    CHECK(even.phases[1].speed_mm_s == 20);
    const double even_mm = peaked.phases[2].distance_mm - peaked.phases[1].distance_mm;
    CHECK(even_mm < 1e-15);
}

TEST_CASE("profile 4: an S-curve from rest to rest takes what theory says") {
    // Acceleration and jerk times of 0.05 and 0.01 s: 3 mm each way.
    const Profile whole = s_curve(100, 0, 0, 50, {1000, 1e5});
    CHECK(whole.duration_s ==
          doctest::Approx(100.0 / 50 + 50.0 / 1000 + 1000 / 1e5).epsilon(1e-12));
    // Too short for either limit: four jerks of (s / 2j)^(1/3).
    const Profile brief = s_curve(1e-3, 0, 0, 50, {1000, 1e5});
    CHECK(brief.duration_s == doctest::Approx(4 * std::cbrt(1e-3 / 2e5)).epsilon(1e-9));
    CHECK(brief.speed_at(brief.duration_s / 2) ==
          doctest::Approx(1e5 * std::pow(std::cbrt(1e-3 / 2e5), 2)).epsilon(1e-9));
}

TEST_CASE("profile 1, 2, 4, 5: S-curves keep their limits, and reach what is reachable") {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 5000; ++i) {
        const double length = std::pow(10, 6 * share(random) - 4), top = 1 + 300 * share(random);
        const RampLimits limits{100 + 5000 * share(random), std::pow(10, 3 + 4 * share(random))};
        const double v = i % 5 ? top * share(random) : 0;
        const double reached = reachable_mm_s(v, length, limits);
        REQUIRE(reached >= v);
        const double w =
            i % 3 ? v + (std::min(top, reached) - v) * share(random) : std::min(top, reached);
        for (const bool up : {true, false}) {
            const Profile profile = s_curve(length, up ? v : w, up ? w : v, top, limits);
            REQUIRE(profile.distance_at(profile.duration_s) ==
                    doctest::Approx(length).epsilon(1e-9));
            REQUIRE(profile.time_at(length / 3) <= profile.duration_s);
            REQUIRE(profile.distance_at(profile.time_at(length / 3)) ==
                    doctest::Approx(length / 3).epsilon(1e-9));
            for (std::size_t k = 0; k < Profile::phase_count; ++k) {
                const Phase& phase = profile.phases[k];
                const double end_s = k + 1 < Profile::phase_count ? profile.phases[k + 1].time_s
                                                                  : profile.duration_s;
                const double lasts_s = end_s - phase.time_s;
                if (!(lasts_s > 0)) continue;
                const double end_mm_s2 = phase.acceleration_mm_s2 + phase.jerk_mm_s3 * lasts_s;
                constexpr double rounding = 1 + 1e-6;
                REQUIRE(phase.speed_mm_s <= top * rounding);
                REQUIRE(std::abs(phase.acceleration_mm_s2) <= limits.acceleration_mm_s2 * rounding);
                REQUIRE(std::abs(end_mm_s2) <= limits.acceleration_mm_s2 * rounding);
                // A change of speed of which only a few digits are left needs the jerk of the rounded one.
                const double rounded_mm_s3 = 1e-13 * top / (lasts_s * lasts_s);
                REQUIRE(std::abs(phase.jerk_mm_s3) <= limits.jerk_mm_s3 * rounding + rounded_mm_s3);
                if (k + 1 == Profile::phase_count) break;
                const Phase& next = profile.phases[k + 1];
                REQUIRE(next.distance_mm == doctest::Approx(profile.distance_at(end_s)));
                REQUIRE(std::abs(phase.speed_mm_s +
                                 lasts_s * (phase.acceleration_mm_s2 + end_mm_s2) / 2 -
                                 next.speed_mm_s) < 1e-6 * top);
            }
        }
        if (reached > top) continue;
        // And no more: what is reached takes the whole length.
        const Profile all = s_curve(length, v, reached, reached, limits);
        REQUIRE(all.duration_s * (v + reached) / 2 == doctest::Approx(length).epsilon(1e-9));
    }
}

TEST_CASE(
    "profile 6: a peak is the highest speed of its profile, and over a part of the length lower") {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> share(0, 1);
    const auto highest = [](const Profile& profile) {
        double speed = 0;
        for (const Phase& phase : profile.phases) speed = std::max(speed, phase.speed_mm_s);
        return speed;
    };
    for (int i = 0; i < 1000; ++i) {
        const double length = std::pow(10, 4 * share(random) - 2), top = 5 + 300 * share(random);
        const RampLimits limits{100 + 5000 * share(random), std::pow(10, 4 + 2 * share(random))};
        const double a = limits.acceleration_mm_s2, part = length * (0.1 + 0.8 * share(random));
        const double v = std::min(4.0, reachable_mm_s(0, part, limits)) * share(random);
        const double level = trapezoid_peak_mm_s(length, v, 0, top, a);
        const double bent = s_curve_peak_mm_s(length, v, 0, top, limits);
        REQUIRE(level == doctest::Approx(highest(trapezoid(length, v, 0, top, a))));
        REQUIRE(bent == doctest::Approx(highest(s_curve(length, v, 0, top, limits))));
        REQUIRE(trapezoid_peak_mm_s(part, v, 0, top, a) <= level);
        REQUIRE(s_curve_peak_mm_s(part, v, 0, top, limits) <= bent);
        REQUIRE(bent <= level * (1 + 1e-9));
    }
}

}  // namespace lyr::motion
