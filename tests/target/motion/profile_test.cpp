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

}  // namespace lyr::motion
