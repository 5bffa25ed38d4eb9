// The contract in kernel/geometry/curve_approximation.h, by its numbers.

#include "kernel/geometry/curve_approximation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernel/geometry/tolerance.h"

using namespace lyr;

namespace {

constexpr double allowed_mm = resolution_mm / 4;

const CurveFunction helix = CurveFunction::of([](const auto& t) {
    using std::cos;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    return Triple<T>{T(20.0) * cos(t), T(20.0) * sin(t), T(0.7) * t};
});

// Along x, then up: |t| has a corner.
const CurveFunction corner = CurveFunction::of([](const auto& t) {
    using std::sqrt;
    using T = std::decay_t<decltype(t)>;
    return Triple<T>{t, T(0.0), sqrt(t * t)};
});

}  // namespace

TEST_CASE("1: a helix of many turns, by a few pieces a turn") {
    const auto curve = approximated({{-3, 90, helix}}, allowed_mm);
    REQUIRE(curve.has_value());
    CHECK(curve->domain_start() == -3);
    CHECK(curve->domain_end() == 90);
    CHECK(!curve->closed);
    for (int i = 0; i <= 20000; ++i) {
        const double t = -3 + 93.0 * i / 20000;
        const Triple<double> exact = helix.value(t);
        CHECK((evaluate(Curve(*curve), t) - Point3(exact[0], exact[1], exact[2])).norm() <=
              allowed_mm);
    }
    constexpr double most_pieces_a_turn = 10;
    const double turns = 93 / (2 * std::numbers::pi);
    CHECK(static_cast<double>(curve->control_points.size()) < 7 * most_pieces_a_turn * turns);
}

TEST_CASE("1: pieces follow each other; a whole turn is closed") {
    const CurveFunction circle = CurveFunction::of([](const auto& t) {
        using std::cos;
        using std::sin;
        using T = std::decay_t<decltype(t)>;
        return Triple<T>{cos(t), sin(t), T(0.0)};
    });
    const double turn = 2 * std::numbers::pi;
    const auto curve = approximated({{0, 1, circle}, {1, turn, circle}}, allowed_mm);
    REQUIRE(curve.has_value());
    CHECK(curve->closed);
    for (int i = 0; i <= 1000; ++i) {
        const Point3 p = evaluate(Curve(*curve), turn * i / 1000);
        CHECK(std::abs(p.norm() - 1) <= allowed_mm);
    }
}

TEST_CASE("2: a corner inside a piece has no curve, between pieces it has one, a gap has none") {
    CHECK(!approximated({{-1, 2, corner}}, allowed_mm).has_value());
    const CurveFunction down = CurveFunction::of([](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return Triple<T>{t, T(0.0), T(0.0) - t};
    });
    const CurveFunction up = CurveFunction::of([](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return Triple<T>{t, T(0.0), t};
    });
    CHECK(approximated({{-1, 0, down}, {0, 2, up}}, allowed_mm).has_value());
    CHECK(!approximated({{-1, -0.5, down}, {0, 2, up}}, allowed_mm).has_value());
}
