#include "target/motion/path.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lyr::motion {
namespace {

using std::numbers::pi;

double distance(const Point& a, const Point& b) {
    return std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
}

const Arc& arc_of(const Path& path) {
    REQUIRE(std::holds_alternative<Arc>(path));
    return std::get<Arc>(path);
}

}  // namespace

TEST_CASE("path 1: an arc runs from its start to its end, whatever its sagitta") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-200, 200);
    for (double size = 1e-15; size < 3000; size *= 3)
        for (const double sagitta_mm : {size, -size}) {
            const Point from{place(random), place(random), 1}, to{place(random), place(random), 2};
            const Path path = arc_through(from, to, sagitta_mm, 0);
            CHECK(distance(point_at(path, 0), from) == 0);
            // From a radius of 1 m on, a turn of nearly 2 pi is known to its last digit only.
            const double allowed_mm = 1e-12 + 1e-15 * size;
            CHECK(distance(point_at(path, length_of(path)), to) < allowed_mm);
        }
}

TEST_CASE("path 2: the middle of an arc is off the chord's middle by the sagitta") {
    for (double sagitta_mm = 1e-9; sagitta_mm < 100; sagitta_mm *= 1.7)
        for (const double sign : {1.0, -1.0}) {
            const Path path = arc_through({0, 0, 0}, {10, 0, 0}, sign * sagitta_mm, 0);
            const Point middle = point_at(path, length_of(path) / 2);
            CHECK(middle.x == doctest::Approx(5).epsilon(1e-12));
            // Counter-clockwise from left to right bulges downwards.
            CHECK(-sign * middle.y == doctest::Approx(sagitta_mm).epsilon(1e-12));
            const Arc& arc = arc_of(path);
            CHECK(arc.sweep_rad * sign > 0);
            CHECK(arc.radius_mm * (1 - std::cos(arc.sweep_rad / 2)) ==
                  doctest::Approx(sagitta_mm).epsilon(1e-6));
        }
}

TEST_CASE("path 2: half a turn has the radius for a sagitta, a wider arc more") {
    const Arc half = arc_of(arc_through({1, 0, 0}, {-1, 0, 0}, 1, 0));
    CHECK(half.sweep_rad == doctest::Approx(pi).epsilon(1e-15));
    CHECK(half.radius_mm == doctest::Approx(1).epsilon(1e-15));
    CHECK(std::abs(half.center_x_mm) + std::abs(half.center_y_mm) < 1e-15);
    // Nearly all of a circle of radius 1.
    const double gap = 1e-3;
    const Arc wide = arc_of(arc_through({std::cos(gap), std::sin(gap), 0},
                                        {std::cos(gap), -std::sin(gap), 0}, 1 + std::cos(gap), 0));
    CHECK(wide.sweep_rad == doctest::Approx(2 * pi - 2 * gap).epsilon(1e-13));
    CHECK(wide.radius_mm == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("path 2: without a sagitta or a chord there is no arc but a line") {
    CHECK(std::holds_alternative<Line>(arc_through({0, 0, 0}, {1, 0, 0}, 0, 0)));
    CHECK(std::holds_alternative<Line>(arc_through({0, 0, 0}, {1, 0, 0}, 1e-300, 0)));
    CHECK(std::holds_alternative<Line>(arc_through({1, 1, 0}, {1, 1, 5}, 3, 0)));
    CHECK(std::holds_alternative<Line>(circle_about({1, 1, 0}, 1, 1, true, 0, 2)));
    CHECK(std::holds_alternative<Line>(arc_about(0, 0, 0, 1, 1, 0, 0, 0)));
}

TEST_CASE("path 1: a circle ends where it starts, an arc where its angles say") {
    for (const bool counter_clockwise : {true, false}) {
        const Path circle = circle_about({3, 4, 0}, 0, 0, counter_clockwise, 0, 0);
        CHECK(length_of(circle) == doctest::Approx(10 * pi).epsilon(1e-15));
        CHECK(distance(point_at(circle, length_of(circle)), {3, 4, 0}) < 1e-14);
        const Point quarter = point_at(circle, length_of(circle) / 4);
        const double sign = counter_clockwise ? 1 : -1;
        CHECK(distance(quarter, {-4 * sign, 3 * sign, 0}) < 1e-14);
    }
    const Path arc = arc_about(1, 2, 5, pi / 6, -pi / 2, 0, 1, 0);
    CHECK(distance(end_of(arc), {1 + 5 * std::cos(pi / 3), 2 - 5 * std::sin(pi / 3), 1}) < 1e-14);
}

TEST_CASE("path 3: a helix counts its rise, the extruder alone its advance") {
    const Path helix = circle_about({2, 0, 0}, 0, 0, true, 3, 7);
    CHECK(length_of(helix) == doctest::Approx(std::hypot(4 * pi, 3)).epsilon(1e-15));
    CHECK(length_of(Line{{1, 1, 1}, {1, 1, 1}, -2.5}) == 2.5);
    CHECK(length_of(Line{{1, 1, 1}, {1, 1, 3}, -2.5}) == 2);
    CHECK(length_of(Line{}) == 0);
}

TEST_CASE("path 4: the tangent has length 1 and is the derivative of the way") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> even(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const Point from{even(random), even(random), even(random)};
        const Point to{even(random), even(random), even(random)};
        const Path path = arc_through(from, to, even(random), 0.1);
        const double length_mm = length_of(path);
        const double at_mm = length_mm * std::abs(even(random)), h = 1e-5;
        const Point tangent = tangent_at(path, at_mm);
        CHECK(std::hypot(tangent.x, tangent.y, tangent.z) == doctest::Approx(1).epsilon(1e-14));
        const Point a = point_at(path, at_mm - h), b = point_at(path, at_mm + h);
        const Point slope{(b.x - a.x) / (2 * h), (b.y - a.y) / (2 * h), (b.z - a.z) / (2 * h)};
        const Arc* arc = std::get_if<Arc>(&path);
        const double curvature = arc ? 1 / arc->radius_mm : 0;
        CHECK(distance(tangent, slope) < 1e-9 + h * h * curvature * curvature);
    }
    CHECK(tangent_at(Line{{}, {}, 1}, 0.5) == Point{});
}

}  // namespace lyr::motion
