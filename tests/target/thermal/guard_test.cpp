// Contract of target/thermal/guard.h, by number, by lists of samples.

#include "target/thermal/guard.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "target/thermal/pid.h"

using namespace lyr;
using namespace lyr::thermal;

namespace {

struct Fired {
    GuardKind kind;
    double time_s;
};

using Curve = std::function<double(double time_s)>;

struct Watched {
    config::GuardLimits limits = config::default_heater(config::heater_tool).guard;
    double target_c = 200, power = 1;
    // A converter's figure changes from tick to tick.
    bool noisy = true;
};

std::optional<Fired> fired(const Watched& watched, const Curve& temperature_c, double until_s) {
    GuardState state;
    for (int tick = 0; tick * tick_s <= until_s; ++tick) {
        const double time_s = tick * tick_s;
        const double noise = watched.noisy ? 0.01 * (tick % 2) : 0;
        Sample sample{time_s,
                      2'000 + noise,
                      {temperature_c(time_s) + noise},
                      watched.target_c,
                      watched.power};
        if (const auto trip = watch("tool", watched.limits, state, sample)) {
            CHECK(trip->message.starts_with("heater tool: "));
            return Fired{trip->kind, time_s};
        }
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("guard 1: four bad samples in a row, and no fewer") {
    const Watched watched;
    for (const auto& [bad_c, kind] :
         {std::pair{-5.0, GuardKind::too_cold}, std::pair{280.0, GuardKind::over_temperature}})
        for (int count = 1; count <= 5; ++count) {
            const double from_s = 5, to_s = from_s + (count - 0.5) * tick_s;
            const auto trip = fired(
                watched,
                [&, bad = bad_c](double t) { return t > from_s - 0.01 && t < to_s ? bad : 198.0; },
                10);
            CHECK(trip.has_value() == (count >= 4));
            if (trip) CHECK(trip->kind == kind);
        }
}

TEST_CASE("guard 2: a jump is told from a glitch and from the fastest heater") {
    const Watched watched;
    const auto glitch = [](double t) { return std::abs(t - 5) < 0.04 ? 120.0 : 198.0; };
    CHECK_FALSE(fired(watched, glitch, 20));
    for (const double sign : {1.0, -1.0}) {
        const auto jump = fired(
            watched, [&](double t) { return t < 5 ? 199.0 : 199 + sign * 30; }, 20);
        REQUIRE(jump);
        CHECK(jump->kind == GuardKind::rate);
        CHECK(jump->time_s < 6);
    }
    CHECK_FALSE(fired(
        watched, [](double t) { return std::min(198.0, 20 + 30 * t); }, 20));
}

TEST_CASE("guard 3: heating must gain 2 °C in 20 s, all the way") {
    const Watched watched;
    const auto stands = fired(
        watched, [](double) { return 25.0; }, 30);
    REQUIRE(stands);
    CHECK(stands->kind == GuardKind::too_slow);
    CHECK(stands->time_s == doctest::Approx(20));
    // A little faster than asked, and a little slower.
    CHECK_FALSE(fired(
        watched, [](double t) { return 25 + 0.11 * t; }, 1'500));
    CHECK(fired(
              watched, [](double t) { return 25 + 0.09 * t; }, 100)
              ->kind == GuardKind::too_slow);
    // It may stop only where the target is near.
    CHECK_FALSE(fired(
        watched, [](double t) { return std::min(197.0, 25 + 2 * t); }, 500));
    const auto short_of = fired(
        watched, [](double t) { return std::min(190.0, 25 + 2 * t); }, 500);
    REQUIRE(short_of);
    CHECK(short_of->kind == GuardKind::too_slow);
    Watched off = watched;
    off.target_c = 0;
    CHECK_FALSE(fired(
        off, [](double) { return 25.0; }, 100));
}

TEST_CASE("guard 3: a target that changed often gave a dead heater its time anew each time") {
    // A heater that is dead from the begin, and one that died at its target and cools; targets that change every 8 s.
    const config::GuardLimits limits = config::default_heater(config::heater_tool).guard;
    for (const double other_c : {209.0, 211.0, 150.0, 30.0, 0.0})
        for (const bool is_cold : {true, false}) {
            CAPTURE(other_c);
            CAPTURE(is_cold);
            GuardState state;
            std::optional<Trip> trip;
            double time_s = 0;
            for (int tick = 0; !trip && time_s < 900; time_s = ++tick * tick_s) {
                const double target_c = std::fmod(time_s, 16) < 8 ? 210 : other_c;
                const double t = is_cold ? 22 : 21 + 189 * std::exp(-time_s / 120);
                const Sample sample{time_s, 2'000.0 + tick % 2, {t}, target_c, 1};
                trip = watch("tool", limits, state, sample);
            }
            REQUIRE(trip);
            CHECK(time_s < 60);
        }
}

TEST_CASE("guard 3: targets that change often do not make a heater that heats too slow") {
    for (const double other_c : {211.0, 150.0, 0.0}) {
        CAPTURE(other_c);
        const config::GuardLimits limits = config::default_heater(config::heater_tool).guard;
        GuardState state;
        double t = 22;
        for (int tick = 0; tick * tick_s < 900; ++tick) {
            const double time_s = tick * tick_s;
            const double target_c = std::fmod(time_s, 16) < 8 ? 210 : other_c;
            const Sample sample{time_s, 2'000.0 + tick % 2, {t}, target_c, 1};
            CHECK_FALSE(watch("tool", limits, state, sample));
            t += (t < target_c ? 1.5 : -0.5) * tick_s;
        }
    }
}

TEST_CASE("guard 3: what was left of a time is gone once the target was reached") {
    const config::GuardLimits limits = config::default_heater(config::heater_tool).guard;
    GuardState state;
    // A target that is too far for 19 s, near at once, a little too far, and far again.
    for (int tick = 0; tick < 380; ++tick) {
        const double time_s = tick * tick_s, t = time_s < 19.6 ? 100 : 101;
        const double target_c = time_s < 19 ? 210 : time_s < 19.4 ? 102 : time_s < 20 ? 104.5 : 150;
        const Sample sample{time_s, 2'000.0 + tick % 2, {t}, target_c, 1};
        CHECK_FALSE(watch("tool", limits, state, sample));
    }
}

TEST_CASE("guard 4: falling while heating, but for the first seconds") {
    const Watched watched;
    const auto falls = fired(
        watched, [](double t) { return t < 30 ? 25 + 2 * t : 85 - 1.5 * (t - 30); }, 60);
    REQUIRE(falls);
    CHECK(falls->kind == GuardKind::falling);
    CHECK(falls->time_s == doctest::Approx(30 + 4 / 1.5).epsilon(0.02));
    // Heating begins while the sensor still tells of cooling.
    CHECK_FALSE(fired(
        watched, [](double t) { return std::min(198.0, t < 6 ? 150 - 2 * t : 138 + 2 * (t - 6)); },
        100));
}

TEST_CASE("guard 5: straying for longer than 40 s, and not for less") {
    const Watched watched;
    const auto dip = [](double length_s) {
        return [=](double t) { return t > 50 && t < 50 + length_s ? 194.0 : 200.0; };
    };
    CHECK_FALSE(fired(watched, dip(39), 200));
    const auto strays = fired(watched, dip(60), 200);
    REQUIRE(strays);
    CHECK(strays->kind == GuardKind::stray);
    CHECK(strays->time_s == doctest::Approx(90).epsilon(0.01));
    // Two dips of 30 s are not one of 60.
    CHECK_FALSE(fired(
        watched, [](double t) { return std::fmod(t, 40) < 30 && t > 40 ? 194.0 : 200.0; }, 400));
}

TEST_CASE("guard 5: how long one has strayed is forgotten with the target") {
    const config::GuardLimits limits = config::default_heater(config::heater_tool).guard;
    GuardState state;
    const auto holds = [&](double from_s, double to_s, double target_c, double t) {
        for (int tick = static_cast<int>(from_s / tick_s); tick * tick_s < to_s; ++tick) {
            const Sample sample{tick * tick_s, 2'000.0 + tick % 2, {t}, target_c, 1};
            const auto trip = watch("tool", limits, state, sample);
            if (trip) return false;
        }
        return true;
    };
    CHECK(holds(0, 10, 200, 200));
    CHECK(holds(10, 45, 200, 195));
    // Near enough to a higher one in a single sample, and less so afterwards.
    CHECK(holds(45, 50, 210, 204));
    CHECK(holds(50, 50.1, 210, 206.1));
    CHECK(holds(50.1, 90, 210, 205.9));
    CHECK_FALSE(holds(90, 92, 210, 205.9));
}

TEST_CASE("guard 6: rising while off, but neither the lag nor a warm neighbour") {
    Watched off;
    off.target_c = 0;
    off.power = 0;
    const auto rises = fired(
        off, [](double t) { return 25 + 0.5 * t; }, 60);
    REQUIRE(rises);
    CHECK(rises->kind == GuardKind::stuck_on);
    CHECK(rises->time_s < 10 + 4 / 0.4 + 1);
    CHECK_FALSE(fired(
        off, [](double t) { return std::min(40.0, 25 + 3 * t); }, 60));
    CHECK_FALSE(fired(
        off, [](double t) { return 25 + 0.05 * t; }, 600));
    CHECK_FALSE(fired(
        off, [](double t) { return 200 - 0.5 * t; }, 300));
    Watched on = off;
    on.power = 0.2;
    CHECK_FALSE(fired(
        on, [](double t) { return 25 + 0.5 * t; }, 60));
}

TEST_CASE("guard 6: what a slow sensor still has to tell was taken for a stuck switch") {
    // A bed of 400 W: the plate gains 0.55 °C/s, and its sensor lags by 30 s.
    const double gain_c_s = 0.55, lag_s = 30, off_s = 100;
    config::GuardLimits limits = config::default_heater(config::heater_bed).guard;
    const auto watched = [&](bool sticks) -> std::optional<Fired> {
        GuardState state;
        double plate_c = 21, sensor_c = 21;
        for (int tick = 0; tick * tick_s < off_s + 200; ++tick) {
            const double time_s = tick * tick_s, power = time_s < off_s ? 1 : 0;
            const Sample sample{
                time_s, 2'000.0 + tick % 2, {sensor_c}, power > 0 ? 120.0 : 0.0, power};
            if (const auto trip = watch("bed", limits, state, sample))
                return Fired{trip->kind, time_s};
            if (power > 0 || sticks) plate_c += gain_c_s * tick_s;
            sensor_c += (plate_c - sensor_c) * tick_s / lag_s;
        }
        return std::nullopt;
    };
    CHECK_FALSE(watched(false));
    const auto stuck = watched(true);
    REQUIRE(stuck);
    CHECK(stuck->kind == GuardKind::stuck_on);
    CHECK(stuck->time_s < off_s + settle_s + 25);
    // An owner who promises a faster sensor has it found sooner.
    limits.gain_time_s = 20;
    CHECK(watched(true)->time_s < stuck->time_s - 5);
}

TEST_CASE(
    "guard 6: a weak bed that was stuck on was found after half an hour, at the end of its range") {
    Watched off;
    off.limits = config::default_heater(config::heater_bed).guard;
    off.target_c = off.power = 0;
    const auto rises = fired(
        off, [](double t) { return 25 + 0.086 * t; }, 1'800);
    REQUIRE(rises);
    CHECK(rises->kind == GuardKind::stuck_on);
    CHECK(rises->time_s < 75);
}

TEST_CASE("guard 7: a figure that never changes while there is a target") {
    Watched watched;
    watched.noisy = false;
    const auto still = [](double) { return 199.0; };
    const auto frozen = fired(watched, still, 60);
    REQUIRE(frozen);
    CHECK(frozen->kind == GuardKind::frozen);
    CHECK(frozen->time_s == doctest::Approx(20));
    watched.target_c = 0;
    CHECK_FALSE(fired(watched, still, 300));
}

TEST_CASE("guard 7: a standing figure is asked with half of the power at the most, and only then") {
    const config::GuardLimits limits;
    GuardState state;
    state.phase = Phase::holding;
    const auto power = [&](double wanted, double stands_s) {
        state.last_time_s = state.same_since_s + stands_s;
        return asking_power(wanted, 0.8, limits, state);
    };
    for (const double wanted : {0.0, 0.1, 0.3, 0.5, 0.8}) {
        CHECK(power(wanted, limits.frozen_time_s / 2) == wanted);
        double before = 0;
        for (double stands_s = 10.1; stands_s <= limits.frozen_time_s; stands_s += 0.1) {
            const double asked = power(wanted, stands_s), moved = std::abs(asked - wanted);
            CHECK(asked >= 0);
            CHECK(asked <= 0.8);
            CHECK(moved >= before);
            CHECK(moved <= 0.4 + 1e-9);
            before = moved;
        }
        CHECK(before >= std::min(0.3, wanted < 0.16 ? 0.4 : wanted));
    }
    state.phase = Phase::heating;
    CHECK(power(0.8, 19) == 0.8);
}
