// The numbers are those of the contract in kernel/geometry/bspline_curve.h.

#include "kernel/geometry/bspline_curve.h"

#include <doctest/doctest.h>

#include <cmath>

#include "kernel/geometry/random_curves.h"
#include "kernel/geometry/tolerance.h"

using namespace lyr;
using lyr::test::Random;

namespace {

// De Casteljau on nine intermediate points of at most 50 mm: far below what coordinates carry.
constexpr double piece_bound_mm = 1e-10;

Point3 bezier_at(const BezierPiece& piece, double t) {
    auto c = piece.control_points;
    for (std::size_t level = c.size() - 1; level > 0; --level) {
        for (std::size_t i = 0; i < level; ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
    }
    return c[0].head<3>() / c[0].w();
}

// A full circle as SolidWorks, CATIA and others write it: quadratic, four arcs, double knots.
BSplineCurve rational_circle(double radius) {
    const double w = std::sqrt(0.5);
    BSplineCurve c{2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {}, {1, w, 1, w, 1, w, 1, w, 1}, true};
    const double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, z[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    for (int i = 0; i < 9; ++i) c.control_points.emplace_back(radius * x[i], 7, radius * z[i]);
    return c;
}

}  // namespace

TEST_CASE("1: the pieces joined are the curve") {
    Random random(11);
    for (int i = 0; i < 500; ++i) {
        const BSplineCurve c = test::random_spline(random);
        double a = random.between(c.domain_start(), c.domain_end());
        double b = random.between(c.domain_start(), c.domain_end());
        if (a > b) std::swap(a, b);
        const auto pieces = bezier_pieces(c, a, b);
        REQUIRE(!pieces.empty());
        CHECK(pieces.front().from == a);
        CHECK(pieces.back().to == b);
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            if (k > 0) CHECK(pieces[k].from == pieces[k - 1].to);
            for (const double t : {0.0, 0.25, 0.6, 1.0}) {
                const double u = pieces[k].from + (pieces[k].to - pieces[k].from) * t;
                CHECK((bezier_at(pieces[k], t) - evaluate(c, u)).norm() <= piece_bound_mm);
            }
        }
    }
}

TEST_CASE("2: the rational circle is a circle") {
    const BSplineCurve c = rational_circle(10);
    for (double t = 0; t <= 4; t += 0.01) {
        const Point3 p = evaluate(c, t);
        CHECK(std::hypot(p.x(), p.z()) == doctest::Approx(10).epsilon(1e-14));
        const double found = invert(c, {2 * p.x(), 9, 2 * p.z()});
        CHECK((evaluate(c, found) - p).norm() <= resolution_mm);
    }
    CHECK(height_extrema(c, 0, 4) == std::vector<double>{1, 3});
    CHECK(height_extrema(c, 3.5, 5.5) == std::vector<double>{5});
    // Equally far from every point: any of them will do, and the search must end.
    CHECK((evaluate(c, invert(c, {0, 7, 0})) - Point3(0, 7, 0)).norm() == doctest::Approx(10));
}

TEST_CASE("2: degenerate splines end with the nearest point too") {
    BSplineCurve c{3, {0, 0, 0, 0, 1, 1, 1, 1}, std::vector<Point3>(4, Point3(1, 2, 3)), {}, false};
    CHECK((evaluate(c, invert(c, {5, 5, 5})) - Point3(1, 2, 3)).norm() == 0);
    CHECK(height_extrema(c, 0, 1).empty());
    // A cusp, where the derivative vanishes on the curve.
    c.control_points = {{0, 0, 0}, {10, 0, 10}, {0, 0, 10}, {10, 0, 0}};
    const Point3 cusp = evaluate(c, 0.5);
    CHECK((evaluate(c, invert(c, cusp)) - cusp).norm() <= resolution_mm);
    // A doubled line: there and back.
    c.control_points = {{0, 0, 0}, {10, 0, 10}, {10, 0, 10}, {0, 0, 0}};
    CHECK((evaluate(c, invert(c, {3, 0, 3})) - Point3(3, 0, 3)).norm() <= resolution_mm);
    CHECK(height_extrema(c, 0, 1).size() == 1);
}

TEST_CASE("2: degrees and sizes beyond the usual") {
    Random random(12);
    BSplineCurve c{25, {}, {}, {}, false};
    c.knots.assign(26, 0.0);
    c.knots.insert(c.knots.end(), 26, 1.0);
    for (int i = 0; i < 26; ++i) c.control_points.push_back(random.vector(20));
    const Point3 p = evaluate(c, 0.37);
    CHECK((evaluate(c, invert(c, p)) - p).norm() <= resolution_mm);

    BSplineCurve many{3, {0, 0, 0}, {}, {}, false};
    for (int i = 0; i < 2000; ++i) {
        many.control_points.emplace_back(i * 0.1, std::sin(i * 0.05), std::cos(i * 0.05));
        if (i < 1998) many.knots.push_back(i);
    }
    many.knots.insert(many.knots.end(), 3, 1997);
    REQUIRE(many.knots.size() == many.control_points.size() + 4);
    const Point3 q = evaluate(many, 777.7);
    CHECK(invert(many, q) == doctest::Approx(777.7).epsilon(1e-9));
    CHECK(height_extrema(many, 0, 1997).size() == 31);
}
