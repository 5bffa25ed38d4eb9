// The numbers are those of the contract in kernel/geometry/curve.h.

#include "kernel/geometry/curve.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "kernel/geometry/random_curves.h"
#include "kernel/geometry/tolerance.h"

using namespace lyr;
using lyr::test::inversion_bound_mm;
using lyr::test::Random;
using lyr::test::random_stretch;
using lyr::test::Stretch;
using std::numbers::pi;

namespace {

// Round-off of a few operations on coordinates up to a few thousand millimetres.
constexpr double round_off_mm = 1e-10;
constexpr double height_bound_mm = resolution_mm / 100;
constexpr int dense = 400;

double height(const Curve& curve, double t) {
    return evaluate(curve, t).z();
}

std::vector<double> stops(const Stretch& s) {
    std::vector<double> t{s.from};
    for (const double extremum : height_extrema(s.curve, s.from, s.to)) t.push_back(extremum);
    t.push_back(s.to);
    return t;
}

void check_monotone(const Curve& curve, double from, double to) {
    const double rise = height(curve, to) - height(curve, from);
    double furthest = height(curve, from);
    for (int i = 1; i <= dense; ++i) {
        const double z = height(curve, from + (to - from) * i / dense);
        CHECK((rise >= 0 ? furthest - z : z - furthest) <= resolution_mm + round_off_mm);
        furthest = rise >= 0 ? std::max(furthest, z) : std::min(furthest, z);
    }
}

}  // namespace

TEST_CASE("1: the derivative is the limit of differences") {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Stretch s = random_stretch(random);
        const double t = s.from, h = 1e-6;
        const Vector3 analytic = derivative(s.curve, t);
        const Vector3 before = (evaluate(s.curve, t) - evaluate(s.curve, t - h)) / h;
        const Vector3 after = (evaluate(s.curve, t + h) - evaluate(s.curve, t)) / h;
        const double off = std::min((analytic - before).norm(), (analytic - after).norm());
        CHECK(off <= 1e-3 * (1 + analytic.norm()));
    }
}

TEST_CASE("1: a closed spline repeats, an open one stays at its end") {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        BSplineCurve c = test::random_spline(random);
        const double length = c.domain_end() - c.domain_start();
        const double t = random.between(c.domain_start(), c.domain_end());
        if (c.closed) {
            CHECK(period(Curve(c)) == length);
            CHECK((evaluate(Curve(c), t + 3 * length) - evaluate(Curve(c), t)).norm() <= 1e-8);
        } else {
            CHECK(period(Curve(c)) == 0);
            CHECK(evaluate(Curve(c), c.domain_end() + 1) == evaluate(Curve(c), c.domain_end()));
            CHECK(evaluate(Curve(c), c.domain_start() - 1) == evaluate(Curve(c), c.domain_start()));
        }
    }
}

TEST_CASE("2: a point of the curve is found again") {
    Random random(3);
    for (int i = 0; i < 4000; ++i) {
        const Stretch s = random_stretch(random);
        const Point3 p =
            evaluate(s.curve, random.between(std::min(s.from, s.to), std::max(s.from, s.to)));
        CHECK((evaluate(s.curve, invert(s.curve, p)) - p).norm() <= inversion_bound_mm);
    }
}

TEST_CASE("2: no point of the curve is nearer than the one found") {
    Random random(4);
    for (int i = 0; i < 1500; ++i) {
        const Stretch s = random_stretch(random);
        const Point3 p = random.coin() ? random.vector(60)
                                       : Point3(evaluate(s.curve, s.to) + random.vector(1e-2));
        const double found = (evaluate(s.curve, invert(s.curve, p)) - p).norm();
        double nearest = found;
        for (int k = 0; k <= dense; ++k) {
            const double t = s.from + (s.to - s.from) * k / dense;
            nearest = std::min(nearest, (evaluate(s.curve, t) - p).norm());
        }
        CHECK(found <= nearest + inversion_bound_mm);
    }
}

TEST_CASE("2: points on the symmetry axes of conics") {
    const Frame frame;
    const Curve curves[] = {Circle{frame, 3}, Ellipse{frame, 5, 2}, Ellipse{frame, 2, 5},
                            Parabola{frame, 2}, Hyperbola{frame, 3, 4}};
    for (const Curve& curve : curves) {
        for (double x = -10; x <= 10; x += 0.5) {
            for (const Point3& p : {Point3(x, 0, 0), Point3(0, x, 0), Point3(x, -0.0, 0)}) {
                const double t = invert(curve, p);
                CHECK((period(curve) == 0 || (t > -pi && t <= pi)));
                double nearest = 1e9;
                for (int k = -4000; k <= 4000; ++k) {
                    nearest = std::min(nearest, (evaluate(curve, k * 1e-3) - p).norm());
                }
                CHECK((evaluate(curve, t) - p).norm() <= nearest + inversion_bound_mm);
            }
        }
    }
}

TEST_CASE("2: the far side of a bend does not catch the point") {
    // A hairpin: both legs pass near the point, and Newton's method from the middle ends on the wrong one.
    BSplineCurve hairpin{3, {0, 0, 0, 0, 1, 1, 1, 1}, {}, {}, false};
    hairpin.control_points = {{0, 0, 0}, {100, 0, 0}, {100, 1, 0}, {0, 1, 0}};
    const Curve curve = hairpin;
    for (const double y : {0.1, 0.4, 0.49, 0.51, 0.9}) {
        const double t = invert(curve, {5, y, 0});
        CHECK((y < 0.5) == (t < 0.5));
    }
}

TEST_CASE("3: between neighbours the height is monotone, and each turn is one") {
    Random random(5);
    for (int i = 0; i < 1500; ++i) {
        const Stretch s = random_stretch(random);
        const std::vector<double> t = stops(s);
        for (std::size_t k = 0; k + 1 < t.size(); ++k) {
            CHECK((s.from < s.to ? t[k] < t[k + 1] : t[k] >= t[k + 1]));
            check_monotone(s.curve, t[k], t[k + 1]);
        }
        for (std::size_t k = 1; k + 1 < t.size(); ++k) {
            const double before = height(s.curve, t[k]) - height(s.curve, t[k - 1]);
            const double after = height(s.curve, t[k + 1]) - height(s.curve, t[k]);
            CHECK(before * after < 0);
        }
    }
}

TEST_CASE("3: reversed, the same turns in reverse") {
    Random random(6);
    for (int i = 0; i < 500; ++i) {
        const Stretch s = random_stretch(random);
        std::vector<double> forth = height_extrema(s.curve, s.from, s.to);
        const std::vector<double> back = height_extrema(s.curve, s.to, s.from);
        std::reverse(forth.begin(), forth.end());
        CHECK(forth == back);
    }
}

TEST_CASE("3: upside down, the same turns") {
    Random random(7);
    Eigen::Affine3d flip = Eigen::Affine3d::Identity();
    flip.scale(Vector3(1, 1, -1));
    for (int i = 0; i < 500; ++i) {
        const Stretch s = random_stretch(random);
        const std::vector<double> up = height_extrema(s.curve, s.from, s.to);
        const std::vector<double> down = height_extrema(transformed(s.curve, flip), s.from, s.to);
        REQUIRE(up.size() == down.size());
        for (std::size_t k = 0; k < up.size(); ++k) {
            CHECK(std::abs(height(s.curve, up[k]) - height(s.curve, down[k])) <= round_off_mm);
        }
    }
}

TEST_CASE("3: a level curve has no turns, a vertical circle has two") {
    Frame level;
    CHECK(height_extrema(Circle{level, 10}, 0, 2 * pi).empty());
    const Frame upright{{1, 2, 3}, Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()};
    const auto turns = height_extrema(Circle{upright, 10}, 0, 2 * pi);
    REQUIRE(turns.size() == 2);
    CHECK(turns[0] == doctest::Approx(pi / 2).epsilon(1e-14));
    CHECK(turns[1] == doctest::Approx(3 * pi / 2).epsilon(1e-14));
    // From top to top the ends are no turns, although round-off may put them a little aside.
    for (const double off : {0.0, 1e-15, -1e-15, 1e-9, -1e-9}) {
        CHECK(height_extrema(Circle{upright, 10}, pi / 2 + off, 5 * pi / 2 + off).size() == 1);
    }
    // Tilted by less than the resolution shows: level.
    const double tilt = 1e-9;
    const Frame tilted{{0, 0, 0},
                       {std::cos(tilt), 0, std::sin(tilt)},
                       Vector3::UnitY(),
                       {-std::sin(tilt), 0, std::cos(tilt)}};
    CHECK(height_extrema(Circle{tilted, 10}, 0, 2 * pi).empty());
}

TEST_CASE("3: flat stretches, double turns and kinks of splines") {
    const auto spline = [](std::vector<double> z) {
        BSplineCurve c{static_cast<int>(z.size()) - 1, {}, {}, {}, false};
        c.knots.assign(z.size(), 0.0);
        c.knots.insert(c.knots.end(), z.size(), 1.0);
        for (std::size_t i = 0; i < z.size(); ++i)
            c.control_points.emplace_back(static_cast<double>(i), 0, z[i]);
        return Curve(c);
    };
    CHECK(height_extrema(spline({5, 5, 5, 5}), 0, 1).empty());
    CHECK(height_extrema(spline({0, 1, -1, 0.1}), 0, 1).size() == 2);
    // (t - 1/2)^3 has a level tangent and no turn; its neighbours have none or two.
    CHECK(height_extrema(spline({-1, 1, -1, 1}), 0, 1).empty());
    CHECK(height_extrema(spline({-1, 1 - 1e-6, -1 + 1e-6, 1}), 0, 1).empty());
    CHECK(height_extrema(spline({-1, 1 + 1e-3, -1 - 1e-3, 1}), 0, 1).size() == 2);
    // (t - 1/2)^4 turns once.
    const auto quartic = height_extrema(spline({1, -1, 1, -1, 1}), 0, 1);
    REQUIRE(quartic.size() == 1);
    CHECK(quartic[0] == doctest::Approx(0.5).epsilon(0.02));
    // A plateau between a rise and a fall is one turn, between two rises none; a kink is a turn.
    BSplineCurve polyline{
        1, {0, 0, 1, 2, 3, 3}, {{0, 0, 0}, {1, 0, 1}, {2, 0, 1}, {3, 0, 0}}, {}, false};
    CHECK(height_extrema(Curve(polyline), 0, 3).size() == 1);
    polyline.control_points[3].z() = 2;
    CHECK(height_extrema(Curve(polyline), 0, 3).empty());
    polyline.control_points[1].z() = 3;
    CHECK(height_extrema(Curve(polyline), 0, 3) == std::vector<double>{1, 2});
}

TEST_CASE("4: the height is met where the ends bracket it") {
    Random random(8);
    double worst_mm = 0;
    for (int i = 0; i < 1500; ++i) {
        const Stretch s = random_stretch(random);
        const std::vector<double> t = stops(s);
        for (std::size_t k = 0; k + 1 < t.size(); ++k) {
            const double a = height(s.curve, t[k]), b = height(s.curve, t[k + 1]);
            for (const double share :
                 {0.0, 1e-12, 1e-6, 0.3, 0.5, 0.77, 1 - 1e-6, 1 - 1e-12, 1.0}) {
                const double z = a + (b - a) * share;
                const double found = parameter_at_height(s.curve, t[k], t[k + 1], z);
                CHECK(found >= std::min(t[k], t[k + 1]));
                CHECK(found <= std::max(t[k], t[k + 1]));
                const double off = std::abs(height(s.curve, found) - z);
                // Where the stretch's own noise is not monotone, the bracket is as wide as that noise.
                if (std::abs(b - a) > resolution_mm) worst_mm = std::max(worst_mm, off);
            }
        }
    }
    CHECK(worst_mm <= height_bound_mm);
}

TEST_CASE("4: outside the bracket the nearer end is returned") {
    Random random(9);
    for (int i = 0; i < 1000; ++i) {
        const Stretch s = random_stretch(random);
        const std::vector<double> t = stops(s);
        const double a = height(s.curve, t[0]), b = height(s.curve, t[1]);
        if (std::abs(a - b) < 1e-3) continue;
        const double above = std::max(a, b) + 1e-5, below = std::min(a, b) - 1e-5;
        CHECK(parameter_at_height(s.curve, t[0], t[1], above) == (a > b ? t[0] : t[1]));
        CHECK(parameter_at_height(s.curve, t[0], t[1], below) == (a > b ? t[1] : t[0]));
    }
}

TEST_CASE("5, 6: a moved, mirrored and scaled curve is the curve moved, mirrored and scaled") {
    Random random(10);
    for (int i = 0; i < 2000; ++i) {
        const Stretch s = random_stretch(random);
        const bool is_line = std::holds_alternative<Line>(s.curve);
        const Eigen::Affine3d move = random.similarity(!is_line);
        const Curve moved = transformed(s.curve, move);
        for (const double t : {s.from, s.to}) {
            const Point3 expected = move * evaluate(s.curve, t);
            CHECK((evaluate(moved, t) - expected).norm() <= 1e-8);
            CHECK((evaluate(moved, invert(moved, expected)) - expected).norm() <=
                  inversion_bound_mm);
        }
    }
    // A line's parameter is a length and scales with it.
    Eigen::Affine3d twice = Eigen::Affine3d::Identity();
    twice.scale(2.0);
    const Curve line = Line{{1, 0, 0}, Vector3::UnitX()};
    CHECK(evaluate(transformed(line, twice), 6) == twice * evaluate(line, 3));
}
