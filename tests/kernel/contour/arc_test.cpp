#include "kernel/contour/arc.h"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace lyr;

namespace {

using std::numbers::pi;

// Arcs of every size and direction, from nearly straight to nearly full.
template <class Check>
void for_many_arcs(Check check) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 3000; ++i) {
        const Point2 centre(100 * unit(random), 100 * unit(random));
        const double radius = std::pow(10.0, 3 * unit(random)), angle = pi * unit(random);
        double sweep = 1.9 * pi * unit(random);
        if (i % 3 == 0) sweep *= 1e-4;
        const auto on = [&](double a) {
            return Point2(centre + radius * Vector2(std::cos(a), std::sin(a)));
        };
        check(on(angle), arc_with_sweep(on(angle), on(angle + sweep), sweep), centre, radius, angle,
              sweep);
    }
}

}  // namespace

TEST_CASE("arc 1: an arc knows its circle, sweep and length") {
    for_many_arcs([](const Point2& start, const Segment& arc, const Point2& centre, double radius,
                     double, double sweep) {
        CHECK(sweep_rad(start, arc) == doctest::Approx(sweep).epsilon(1e-9));
        CHECK(length_mm(start, arc) == doctest::Approx(radius * std::abs(sweep)).epsilon(1e-8));
        const auto circle = circle_of(start, arc);
        REQUIRE(circle);
        // The centre of a flat arc is far beyond its chord: its place is worth that much less.
        const double leverage = std::max(1.0, 4 / (sweep * sweep));
        CHECK((circle->centre - centre).norm() < 1e-11 * (100 + radius) * leverage);
        CHECK(std::abs(circle->radius_mm - radius) < 1e-11 * (100 + radius) * leverage);
    });
}

TEST_CASE("arc 1: points and tangents lie on the circle, in the direction of travel") {
    for_many_arcs([](const Point2& start, const Segment& arc, const Point2& centre, double radius,
                     double angle, double sweep) {
        const double turn = sweep > 0 ? 1 : -1, bound = 1e-10 * (100 + radius);
        for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0}) {
            const double a = angle + share * sweep;
            const Point2 expected = centre + radius * Vector2(std::cos(a), std::sin(a));
            CHECK((point_at(start, arc, share) - expected).norm() < bound);
            CHECK(distance_mm(start, arc, expected) <
                  bound * std::max(1.0, 1e-3 / std::abs(sweep)));
        }
        const auto tangent = [&](double a) {
            return Vector2(turn * Vector2(-std::sin(a), std::cos(a)));
        };
        const double chord = (arc.end - start).norm();
        CHECK((start_tangent(start, arc) - tangent(angle)).norm() < 1e-12 * (1e3 + 1e3 / chord));
        CHECK((end_tangent(start, arc) - tangent(angle + sweep)).norm() <
              1e-12 * (1e3 + 1e3 / chord));
    });
}

TEST_CASE("arc 3: the enclosed area is that of the circular segment, reversed it is negative") {
    for_many_arcs([](const Point2& start, const Segment& arc, const Point2&, double radius, double,
                     double sweep) {
        const long double s = sweep, expected = radius * radius / 2 * (s - std::sin(s));
        if (std::abs(sweep) > 0.01) {
            CHECK(enclosed_area_mm2(start, arc) ==
                  doctest::Approx(static_cast<double>(expected)).epsilon(1e-8));
        }
        CHECK(enclosed_area_mm2(arc.end, {start, -arc.sagitta_mm}) ==
              doctest::Approx(-enclosed_area_mm2(start, arc)).epsilon(1e-12));
    });
}

TEST_CASE("arc 2: nothing jumps where an arc becomes a line") {
    const Point2 start(3, 4);
    const Segment line{{10, -2}}, flat{{10, -2}, 1e-13};
    CHECK(sweep_rad(start, flat) == doctest::Approx(0).epsilon(1e-12));
    CHECK(length_mm(start, flat) == doctest::Approx(length_mm(start, line)).epsilon(1e-14));
    CHECK(std::abs(enclosed_area_mm2(start, flat)) < 1e-11);
    CHECK((start_tangent(start, flat) - start_tangent(start, line)).norm() < 1e-12);
    CHECK((point_at(start, flat, 0.3) - point_at(start, line, 0.3)).norm() < 1e-12);
    CHECK(std::abs(distance_mm(start, flat, {0, 0}) - distance_mm(start, line, {0, 0})) < 1e-12);
}

TEST_CASE("arc: length, sweep and area of flat and bent arcs are those of long double") {
    for (int i = 0; i <= 400; ++i) {
        // With t = 2 s / c from 0.001 to 10.
        const double t = std::pow(10.0, i / 100.0 - 3), c = 3;
        const Point2 start(1, 2);
        for (const double turn : {1.0, -1.0}) {
            const Segment arc{start + Vector2(0, c), turn * t * c / 2};
            const long double x = 2.0L * std::abs(arc.sagitta_mm) / c, q = std::atan(x);
            const long double w = 1 + x * x;
            const auto length = static_cast<double>(c * w * q / x);
            const auto area =
                static_cast<double>(c * c / (8 * x * x) * (w * w * q - x * (1 - x * x)));
            CHECK(length_mm(start, arc) == doctest::Approx(length).epsilon(1e-14));
            CHECK(sweep_rad(start, arc) ==
                  doctest::Approx(turn * static_cast<double>(4 * q)).epsilon(1e-14));
            CHECK(enclosed_area_mm2(start, arc) == doctest::Approx(turn * area).epsilon(1e-12));
        }
    }
}
