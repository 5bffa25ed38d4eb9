// The contract in kernel/geometry/bspline_offset.h, by its numbers.

#include "kernel/geometry/bspline_offset.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/surface.h"

using namespace lyr;
using std::numbers::pi;

namespace {

BSplineSurface offset_of(const BSplineSurface& surface, double distance_mm) {
    const auto result = offset(surface, distance_mm);
    REQUIRE(std::holds_alternative<BSplineSurface>(result));
    return std::get<BSplineSurface>(result);
}

OffsetFailure failure_of(const BSplineSurface& surface, double distance_mm) {
    const auto result = offset(surface, distance_mm);
    REQUIRE(std::holds_alternative<OffsetFailure>(result));
    return std::get<OffsetFailure>(result);
}

// Calls with parameters on a dense grid, borders included.
void for_each_place(const BSplineSurface& s, const std::function<void(const Point2&)>& visit) {
    constexpr int steps = 40;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            visit({s.start_u() + (s.end_u() - s.start_u()) * i / steps,
                   s.start_v() + (s.end_v() - s.start_v()) * j / steps});
        }
    }
}

double error_mm(const BSplineSurface& surface, const BSplineSurface& result, double distance_mm) {
    double worst = 0;
    for_each_place(surface, [&](const Point2& uv) {
        const Point3 exact = evaluate(surface, uv) + distance_mm * normal(surface, uv);
        worst = std::max(worst, (evaluate(result, uv) - exact).norm());
    });
    return worst;
}

// A gently rolling surface of two by three spans, smooth across them.
BSplineSurface rolling(bool rational, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> amount(-1, 1);
    BSplineSurface s{3, 2, 5, 5, {0, 0, 0, 0, 1, 3, 3, 3, 3}, {0, 0, 0, 1, 2, 3, 3, 3}, {}, {}};
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            s.control_points.emplace_back(20 * i + amount(random), 15 * j + amount(random),
                                          6 * amount(random));
            if (rational) s.weights.push_back(1 + 0.3 * amount(random));
        }
    }
    return s;
}

BSplineCurve half_circle(double radius_mm) {
    const Frame upright{{0, 0, 0}, Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()};
    BSplineCurve arc = rational(Circle{upright, radius_mm}, -pi / 2, pi / 2);
    for (Point3* const end : {&arc.control_points.front(), &arc.control_points.back()})
        end->x() = 0;
    return arc;
}

Eigen::Affine3d moved(bool mirror) {
    Eigen::Affine3d to =
        Eigen::Translation3d(40, -7, 3) * Eigen::AngleAxisd(0.7, Vector3(1, 2, -1).normalized());
    if (mirror) to.linear() *= Vector3(1, 1, -1).asDiagonal();
    return to;
}

}  // namespace

TEST_CASE("1: at the same parameters, off by no more than is promised") {
    for (unsigned seed = 0; seed < 4; ++seed) {
        const BSplineSurface surface = rolling(seed % 2 == 1, seed);
        for (const double distance_mm : {-3.0, 0.001, 0.5, 3.0}) {
            const BSplineSurface result = offset_of(surface, distance_mm);
            CHECK(error_mm(surface, result, distance_mm) <= offset_accuracy_mm);
        }
    }
}

TEST_CASE("1: the bound holds for surfaces moved and mirrored") {
    for (const bool mirror : {false, true}) {
        const BSplineSurface surface = transformed(rolling(true, 11), moved(mirror));
        CHECK(surface.mirrored == mirror);
        for (const double distance_mm : {-2.0, 2.0}) {
            const BSplineSurface result = offset_of(surface, distance_mm);
            CHECK(error_mm(surface, result, distance_mm) <= offset_accuracy_mm);
        }
    }
}

TEST_CASE("1: an extruded circle gives a cylinder, straight along its axis") {
    const Frame axis;
    const BSplineSurface surface =
        extruded(rational(Circle{axis, 10}, 0, 2 * pi), 30 * Vector3::UnitZ());
    for (const double distance_mm : {-9.0, -4.0, 5.0, 60.0}) {
        const BSplineSurface result = offset_of(surface, distance_mm);
        CHECK(result.degree_v == 1);
        CHECK(result.closed_u);
        for_each_place(result, [&](const Point2& uv) {
            const Point3 p = evaluate(result, uv);
            CHECK(std::abs(p.head<2>().norm() - (10 + distance_mm)) <= offset_accuracy_mm);
        });
    }
}

TEST_CASE("1, 2: a turned half circle gives a sphere, poles and all") {
    const BSplineSurface sphere = transformed(revolved(half_circle(10), Frame{}), moved(false));
    const Point3 centre = moved(false) * Point3(0, 0, 0);
    // Beyond its centre a sphere is one again.
    for (const double distance_mm : {-14.0, -6.0, 2.5}) {
        const BSplineSurface result = offset_of(sphere, distance_mm);
        CHECK(result.closed_u);
        for_each_place(result, [&](const Point2& uv) {
            const Point3 p = evaluate(result, uv);
            CHECK(std::abs((p - centre).norm() - std::abs(10 + distance_mm)) <= offset_accuracy_mm);
            CHECK((normal(result, uv) - normal(sphere, uv)).norm() < 1e-6);
        });
    }
}

TEST_CASE("2: a pole that the file's rounding has torn open is one") {
    BSplineSurface sphere = revolved(half_circle(10), Frame{});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> amount(-resolution_mm / 4, resolution_mm / 4);
    for (std::size_t i = 0; i < sphere.count_u; ++i) {
        for (Point3* const p : {&sphere.control_points[i * sphere.count_v],
                                &sphere.control_points[(i + 1) * sphere.count_v - 1]}) {
            *p += Vector3(amount(random), amount(random), amount(random));
        }
    }
    const BSplineSurface result = offset_of(sphere, 2);
    for_each_place(result, [&](const Point2& uv) {
        CHECK(std::abs(evaluate(result, uv).norm() - 12) <= 2 * resolution_mm);
    });
}

TEST_CASE("2: beyond the axis of a cylinder, the normal stays what it was") {
    const BSplineSurface surface =
        extruded(rational(Circle{Frame{}, 3}, 0, 2 * pi), 5 * Vector3::UnitZ());
    const BSplineSurface result = offset_of(surface, -8);
    for_each_place(result, [&](const Point2& uv) {
        CHECK(std::abs(evaluate(result, uv).head<2>().norm() - 5) <= offset_accuracy_mm);
        CHECK((normal(result, uv) - normal(surface, uv)).norm() < 1e-6);
    });
}

TEST_CASE("2: what folds is a failure, on the concave side only") {
    // An extruded parabola z = x^2 / 20: its radius of curvature is 10 at the bottom.
    const BSplineCurve parabola{
        2, {0, 0, 0, 1, 1, 1}, {{-20, 0, 20}, {0, 0, -20}, {20, 0, 20}}, {}};
    const BSplineSurface surface = extruded(parabola, 30 * Vector3::UnitY());
    const double up = normal(surface, {0.5, 0.5}).z() > 0 ? 1 : -1;
    CHECK(failure_of(surface, up * 10.5) == OffsetFailure::folded);
    CHECK(failure_of(surface, up * 40) == OffsetFailure::folded);
    for (const double distance_mm : {up * 9.0, up * -10.5, up * -40.0}) {
        CHECK(error_mm(surface, offset_of(surface, distance_mm), distance_mm) <=
              offset_accuracy_mm);
    }
    // Where a torus of ring 12 and tube 4 meets itself or its own axis of curvature.
    const Frame tube{{12, 0, 0}, Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()};
    const BSplineSurface torus = revolved(rational(Circle{tube, 4}, 0, 2 * pi), Frame{});
    const double out = normal(torus, {0, 0}).x() > 0 ? 1 : -1;
    CHECK(failure_of(torus, out * 9) == OffsetFailure::folded);
    CHECK(error_mm(torus, offset_of(torus, out * 7), out * 7) <= offset_accuracy_mm);
    CHECK(error_mm(torus, offset_of(torus, out * -3), out * -3) <= offset_accuracy_mm);
}

TEST_CASE("3: a crease is a failure, unless its gap may be closed") {
    const auto roof = [](double rise_mm) {
        const BSplineCurve profile{
            1, {0, 0, 1, 2, 2}, {{0, 0, 0}, {5, 0, rise_mm}, {10, 0, 0}}, {}};
        return extruded(profile, 8 * Vector3::UnitY());
    };
    for (const double distance_mm : {-1.0, 1.0})
        CHECK(failure_of(roof(3), distance_mm) == OffsetFailure::creased);
    CHECK(error_mm(roof(3), offset_of(roof(3), 0), 0) == 0);
    // Sides that lean by 1e-6 against each other leave a gap of 2e-6.
    const BSplineSurface almost_flat = roof(2.5e-6);
    constexpr double gap_mm = 2e-6;
    CHECK(failure_of(almost_flat, 2) == OffsetFailure::creased);
    const auto closed = offset(almost_flat, 2, 1.1 * gap_mm);
    REQUIRE(std::holds_alternative<BSplineSurface>(closed));
    CHECK(error_mm(almost_flat, std::get<BSplineSurface>(closed), 2) <=
          2 * gap_mm + offset_accuracy_mm);
}
