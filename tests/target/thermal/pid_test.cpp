// Contract of target/thermal/pid.h, by number.

#include "target/thermal/pid.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace lyr;
using namespace lyr::thermal;

TEST_CASE("pid 1: the power is within its bounds, whatever the readings are") {
    for (const double most : {1.0, 0.4}) {
        PidController pid({0.1, 0.01, 1}, most);
        for (int i = 0; i < 500; ++i) {
            const double power = pid.update(200, 200 + 150 * std::sin(i * i));
            CHECK(power >= 0);
            CHECK(power <= most);
        }
        CHECK(pid.update(0, 20) == 0);
        CHECK(pid.update(-5, 20) == 0);
        CHECK(pid.update(200, std::numeric_limits<double>::quiet_NaN()) == 0);
        CHECK(pid.update(200, std::numeric_limits<double>::infinity()) == 0);
    }
}

TEST_CASE("pid 2: hours of full power are no debt once the target is passed") {
    PidController pid({0.05, 0.01, 0}, 1);
    for (int i = 0; i < 100'000; ++i) REQUIRE(pid.update(200, 100) == 1);
    CHECK(pid.update(200, 205) == 0);
    // Nor do hours above the target delay the heat.
    for (int i = 0; i < 100'000; ++i) REQUIRE(pid.update(200, 230) == 0);
    CHECK(pid.update(200, 190) >= 0.5);
}

TEST_CASE("pid 2: an overshoot does not cost the power that holds the target") {
    PidController pid({0.1, 0.01, 0}, 1);
    double power = 0;
    for (int i = 0; i < 20'000; ++i) power = pid.update(200, 199 + power * 2);
    REQUIRE(power == doctest::Approx(0.5).epsilon(0.01));
    for (int i = 0; i < 100; ++i) CHECK(pid.update(200, 220) == 0);
    CHECK(pid.update(200, 200) == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("pid 2: the integral finds the power that holds the target") {
    PidController pid({0.02, 0.01, 0}, 1);
    double power = 0;
    for (int i = 0; i < 20'000; ++i) power = pid.update(200, 199 + power * 2);
    CHECK(power == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("pid 2: a reading that came late was taken for one in time, and gains were other ones") {
    // A body of the first order, held at its target with readings at any distance: all powers alike.
    double held[2]{}, steepest[2]{};
    for (const int run : {0, 1}) {
        const double passed_s = run == 0 ? tick_s : 8 * tick_s;
        PidController pid({0.02, 0.004, 0.3}, 1);
        double body_c = 20, power = 0, time_s = 0;
        for (; time_s < 40; time_s += passed_s) {
            power = pid.update(60, body_c, passed_s);
            body_c += (power * 100 - (body_c - 20)) * passed_s / 50;
        }
        held[run] = power;
        // The derivative's share by itself, on a ramp.
        PidController slope({0, 0, 0.1}, 1);
        for (time_s = 0; time_s < 20; time_s += passed_s)
            steepest[run] = slope.update(500, 300 - 2 * time_s, passed_s);
        // No time, no change, and no division by it.
        CHECK(std::isfinite(pid.update(60, body_c, 0)));
    }
    CHECK(held[1] == doctest::Approx(held[0]).epsilon(0.05));
    CHECK(steepest[0] == doctest::Approx(0.2).epsilon(0.01));
    CHECK(steepest[1] == doctest::Approx(0.2).epsilon(0.01));
}

TEST_CASE("pid 3: a step of the target makes no kick of the derivative") {
    PidController pid({0, 0, 5}, 1);
    for (int i = 0; i < 100; ++i) CHECK(pid.update(i < 50 ? 100 : 200, 90) == 0);
}

TEST_CASE("slow pwm 4: cycles hold their share on average, to the tick") {
    for (const double share : {0.0, 0.013, 0.25, 0.5, 0.777, 1.0})
        for (const double cycle_s : {0.2, 1.0, 2.5}) {
            SlowPwm pwm(cycle_s);
            int on = 0;
            constexpr int ticks = 25'000;
            for (int i = 0; i < ticks; ++i) on += pwm.next(share);
            CHECK(std::abs(on - share * ticks) <= cycle_s / tick_s);
        }
}

TEST_CASE("slow pwm 4: off is at once, in the middle of a cycle too") {
    SlowPwm pwm(10);
    CHECK(pwm.next(0.9));
    CHECK(pwm.next(0.9));
    CHECK_FALSE(pwm.next(0));
    CHECK_FALSE(pwm.next(std::numeric_limits<double>::quiet_NaN()));
    CHECK(pwm.next(0.9));
}
