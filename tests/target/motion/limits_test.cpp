#include "target/motion/limits.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "machine.h"

namespace lyr::motion {
namespace {

using std::numbers::pi;
constexpr double rounding = 1 + 1e-12;

// The largest acceleration of an axis of the plane anywhere on an arc, at the move's top speed and
// full acceleration along the path, from the arc's geometry.
double largest_acceleration(const Arc& arc, const MoveLimits& own, bool of_x) {
    const double level = arc.radius_mm * std::abs(arc.sweep_rad) / length_of(arc);
    const double along = level * own.acceleration_mm_s2;
    const double across = std::pow(level * own.speed_mm_s, 2) / arc.radius_mm;
    double worst = 0;
    constexpr int looks = 2000;
    for (int i = 0; i <= looks; ++i) {
        const double angle = arc.start_angle_rad + arc.sweep_rad * i / looks;
        const double c = std::abs(std::cos(angle)), s = std::abs(std::sin(angle));
        worst = std::max(worst, of_x ? along * s + across * c : along * c + across * s);
    }
    return worst;
}

double largest_speed(const Arc& arc, const MoveLimits& own, bool of_x) {
    const double level = arc.radius_mm * std::abs(arc.sweep_rad) / length_of(arc);
    double worst = 0;
    constexpr int looks = 2000;
    for (int i = 0; i <= looks; ++i) {
        const double angle = arc.start_angle_rad + arc.sweep_rad * i / looks;
        worst = std::max(worst, std::abs(of_x ? std::sin(angle) : std::cos(angle)));
    }
    return worst * level * own.speed_mm_s;
}

Limits uneven() {
    Limits limits;
    limits.axes = {AxisLimits{200, 3000}, AxisLimits{150, 1000}, AxisLimits{10, 100},
                   AxisLimits{40, 2000}};
    return limits;
}

Move fast(const Path& path) {
    return {path, 1e6, 0, 0};
}

}  // namespace

TEST_CASE("limits 1: a line is as fast as its tightest axis allows") {
    const MoveLimits diagonal = limits_of(fast(Line{{0, 0, 0}, {3, 4, 0}, 0}), uneven());
    CHECK(diagonal.speed_mm_s == doctest::Approx(150 / 0.8));
    CHECK(diagonal.acceleration_mm_s2 == doctest::Approx(1000 / 0.8));
    const MoveLimits feeding = limits_of(fast(Line{{0, 0, 0}, {1, 0, 0}, 8}), uneven());
    CHECK(feeding.speed_mm_s == doctest::Approx(5));
    CHECK(feeding.acceleration_mm_s2 == doctest::Approx(250));
    const MoveLimits drawn_back = limits_of(fast(Line{{0, 0, 0}, {0, 0, 0}, -3}), uneven());
    CHECK(drawn_back.speed_mm_s == 40);
    CHECK(drawn_back.acceleration_mm_s2 == 2000);
    const MoveLimits asked = limits_of({Line{{0, 0, 0}, {3, 4, 0}, 0}, 20, 500, 0}, uneven());
    CHECK(asked.speed_mm_s == 20);
    CHECK(asked.acceleration_mm_s2 == 500);
}

TEST_CASE(
    "limits 1: on an arc no axis exceeds its limits in any direction swept, and one reaches it" *
    doctest::test_suite("long")) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> share(0, 1);
    int at_limit = 0;
    constexpr int arcs = 500;
    for (int i = 0; i < arcs; ++i) {
        const double radius = std::pow(10, 4 * share(random) - 2);
        const double sweep = (i % 2 ? 1 : -1) * 2 * pi * std::pow(share(random), 3);
        const Path path = arc_about(1, 2, radius, 2 * pi * (share(random) - 0.5), sweep, 0,
                                    i % 3 ? 0 : radius * share(random), 0.02 * radius);
        const Arc& arc = std::get<Arc>(path);
        const Limits limits = uneven();
        const MoveLimits own = limits_of(fast(path), limits);
        REQUIRE(own.speed_mm_s > 0);
        REQUIRE(own.acceleration_mm_s2 > 0);
        double used = 0;
        for (const bool of_x : {true, false}) {
            const AxisLimits& axis = limits.axes[of_x ? axis_x : axis_y];
            const double acceleration = largest_acceleration(arc, own, of_x);
            REQUIRE(acceleration <= axis.acceleration_mm_s2 * rounding);
            REQUIRE(largest_speed(arc, own, of_x) <= axis.speed_mm_s * rounding);
            used = std::max(used, acceleration / axis.acceleration_mm_s2);
        }
        const double rise = (arc.to.z - arc.from.z) / length_of(path);
        REQUIRE(own.speed_mm_s * rise <= limits.axes[axis_z].speed_mm_s * rounding);
        REQUIRE(own.acceleration_mm_s2 * rise <= limits.axes[axis_z].acceleration_mm_s2 * rounding);
        const double feed = arc.advance_mm / length_of(path);
        used =
            std::max({used, own.acceleration_mm_s2 * rise / limits.axes[axis_z].acceleration_mm_s2,
                      own.acceleration_mm_s2 * feed / limits.axes[axis_e].acceleration_mm_s2});
        if (used > 1 - 1e-5) ++at_limit;
    }
    CHECK(at_limit == arcs);
}

TEST_CASE(
    "limits 1, 2: what z does not hold back turns and climbs as fast as it would turn on the "
    "level") {
    Limits limits = test::even_limits(100, 3000);
    limits.axes[axis_z] = {1e6, 1e9};
    // Bound by what the turn needs, and by the axes' speed.
    for (const double radius_mm : {0.2, 1e3})
        for (const double asked_mm_s2 : {0.0, 500.0}) {
            const auto limits_with = [&](double rise_mm) {
                const Path path = circle_about({radius_mm, 0, 0}, 0, 0, true, rise_mm, 0);
                return limits_of({path, 1e6, asked_mm_s2, 0}, limits);
            };
            const MoveLimits level = limits_with(0), climbing = limits_with(10 * radius_mm);
            const double share = 2 * pi / std::hypot(2 * pi, 10);
            CHECK(climbing.speed_mm_s * share == doctest::Approx(level.speed_mm_s));
            // Along the path no more than what is asked for.
            CHECK(
                climbing.acceleration_mm_s2 ==
                doctest::Approx(asked_mm_s2 > 0 ? asked_mm_s2 : level.acceleration_mm_s2 / share));
        }
}

TEST_CASE("limits 2: the acceleration asked for bounds the one towards the centre too") {
    Move circle{circle_about({8, 0, 0}, 0, 0, true, 0, 0), 1000, 200, 0};
    const MoveLimits own = limits_of(circle, test::even_limits(1e4, 1e6));
    CHECK(own.speed_mm_s == doctest::Approx(std::sqrt(200.0 * 8)));
    CHECK(own.acceleration_mm_s2 == 200);
}

TEST_CASE("limits 1: a short arc far from an axis's turning point is not limited by that axis") {
    // Near the top of the circle the motion is along x.
    const Path top = arc_about(0, 0, 100, pi / 2 - 1e-4, 2e-4, 0, 0, 0);
    Limits limits = test::even_limits(1e3, 1e6);
    limits.axes[axis_y].speed_mm_s = 1;
    CHECK(limits_of(fast(top), limits).speed_mm_s == doctest::Approx(1e3));
}

TEST_CASE("limits 3: corners of lines have the speed of the junction deviation") {
    Limits limits = test::even_limits(1e3, 1e9);
    limits.junction_deviation_mm = 0.02;
    const double a = 1000;
    for (double turn = 0.05; turn < pi; turn += 0.1) {
        const Point corner{100, 0, 0};
        const Point end{100 + 100 * std::cos(turn), 100 * std::sin(turn), 0};
        const Move before{Line{{0, 0, 0}, corner, 0}, 100, a, 0},
            after{Line{corner, end, 0}, 100, a, 0};
        const double s = std::cos(turn / 2);
        const double expected =
            std::min(std::sqrt(a * 0.02 * s / (1 - s)), std::sqrt(a * 50 / std::tan(turn / 2)));
        CHECK(corner_speed_mm_s(before, after, limits) == doctest::Approx(expected).epsilon(1e-9));
        CHECK(corner_speed_mm_s({test::reversed(after.path), 100, a, 0},
                                {test::reversed(before.path), 100, a, 0},
                                limits) == doctest::Approx(expected).epsilon(1e-9));
    }
}

TEST_CASE("limits 3: a turn back is a stop, going straight on is free") {
    const Limits limits = test::even_limits(100, 1000);
    const Move out = fast(Line{{0, 0, 0}, {10, 5, 1}, 0}), back = fast(test::reversed(out.path));
    CHECK(corner_speed_mm_s(out, back, limits) == 0);
    CHECK(corner_speed_mm_s(out, fast(Line{{10, 5, 1}, {20, 10, 2}, 0}), limits) > 1e6);
}

TEST_CASE("limits 3: a line into a tangent arc, and arc into arc, is not slowed") {
    const Limits limits = test::even_limits(500, 3000);
    for (double angle = -3; angle < 3.1; angle += 0.37)
        for (const double side : {1.0, -1.0})
            for (const double radius : {0.05, 1.0, 30.0, 200.0}) {
                // The arc starts at the origin towards `angle` and bends to one side.
                const double to_center = angle + side * pi / 2;
                const Path arc =
                    arc_about(radius * std::cos(to_center), radius * std::sin(to_center), radius,
                              to_center + pi, side * 1.5, 0, 0, 0);
                const Point start = start_of(arc);
                const Path line = Line{
                    {start.x - 50 * std::cos(angle), start.y - 50 * std::sin(angle), 0}, start, 0};
                const Move before = fast(line), after = fast(arc);
                const double own = std::min(limits_of(before, limits).speed_mm_s,
                                            limits_of(after, limits).speed_mm_s);
                CHECK(corner_speed_mm_s(before, after, limits) > 1000 * own);
                CHECK(corner_speed_mm_s(fast(test::reversed(arc)), fast(test::reversed(line)),
                                        limits) > 1000 * own);
                CHECK(corner_speed_mm_s(after, fast(arc_through(end_of(arc), end_of(arc), 0, 1)),
                                        limits) == 0);
            }
}

TEST_CASE("limits 4: the extruder does not jump, and stops for a motion of its own") {
    Limits limits = test::even_limits(100, 1000);
    limits.extruder_jump_mm_s = 2;
    const Move extruding = fast(Line{{0, 0, 0}, {10, 0, 0}, 1}),
               travel = fast(Line{{10, 0, 0}, {20, 0, 0}, 0});
    const Move alone = fast(Line{{10, 0, 0}, {10, 0, 0}, 1}),
               drawn = fast(Line{{10, 0, 0}, {10, 0, 0}, -1});
    CHECK(corner_speed_mm_s(extruding, travel, limits) == doctest::Approx(20));
    CHECK(corner_speed_mm_s(extruding, alone, limits) == 0);
    CHECK(corner_speed_mm_s(alone, travel, limits) == 0);
    CHECK(corner_speed_mm_s(alone, drawn, limits) == 0);
    CHECK(corner_speed_mm_s(alone, alone, limits) == std::numeric_limits<double>::infinity());
}

TEST_CASE("limits: nonsense is named") {
    for (const double bad : {0.0, -1.0, std::nan(""), 1e300}) {
        for (std::size_t i = 0; i < axis_count; ++i) {
            Limits limits = test::even_limits(1, 1);
            limits.axes[i].speed_mm_s = bad;
            CHECK(!check(limits).ok());
            limits = test::even_limits(1, 1);
            limits.axes[i].acceleration_mm_s2 = bad;
            CHECK(!check(limits).ok());
        }
        Limits limits = test::even_limits(1, 1);
        limits.extruder_jump_mm_s = bad;
        CHECK(!check(limits).ok());
        limits = test::even_limits(1, 1);
        limits.junction_deviation_mm = bad;
        CHECK(check(limits).ok() == (bad == 0));
        limits = test::even_limits(1, 1);
        limits.minimum_cruise_ratio = bad;
        CHECK(check(limits).ok() == (bad == 0));
    }
    Limits limits = test::even_limits(1, 1);
    limits.minimum_cruise_ratio = 1;
    CHECK(!check(limits).ok());
}

}  // namespace lyr::motion
