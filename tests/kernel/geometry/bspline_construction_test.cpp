// Contract 5 of kernel/geometry/bspline_surface.h: what is built of curves is exact.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/random_curves.h"
#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"

using namespace lyr;
using lyr::test::Random;
using std::numbers::pi;

namespace {

// Of coordinates up to a few hundred millimetres, after some ten operations.
constexpr double construction_round_off_mm = 1e-12 * 200;

double extent_mm(const BSplineCurve& c) {
    double largest = 1;
    for (const Point3& p : c.control_points) largest = std::max(largest, p.norm());
    return largest;
}

double distance_mm(const Curve& curve, const Point3& point) {
    return (evaluate(curve, invert(curve, point)) - point).norm();
}

}  // namespace

TEST_CASE("5: a stretch of any curve as a B-spline has its ends and its points") {
    Random random(20);
    for (int i = 0; i < 2000; ++i) {
        test::Stretch s = test::random_stretch(random);
        if (s.from > s.to) std::swap(s.from, s.to);
        if (period(s.curve) > 0) s.to = std::min(s.to, s.from + period(s.curve));
        const BSplineCurve c = rational(s.curve, s.from, s.to);
        REQUIRE(c.knots.size() == c.control_points.size() + static_cast<std::size_t>(c.degree) + 1);
        CHECK(c.domain_start() == doctest::Approx(s.from).epsilon(1e-12));
        CHECK(c.domain_end() == doctest::Approx(s.to).epsilon(1e-12));
        const double bound = 1e-12 * extent_mm(c);
        CHECK((evaluate(c, c.domain_start()) - evaluate(s.curve, s.from)).norm() <= 100 * bound);
        CHECK((evaluate(c, c.domain_end()) - evaluate(s.curve, s.to)).norm() <= 100 * bound);
        for (const double share : {0.1, 0.37, 0.5, 0.92}) {
            const double t = c.domain_start() + share * (c.domain_end() - c.domain_start());
            const bool keeps_parameter = std::holds_alternative<Line>(s.curve) ||
                                         std::holds_alternative<Parabola>(s.curve) ||
                                         std::holds_alternative<BSplineCurve>(s.curve);
            const Point3 p = evaluate(c, t);
            if (keeps_parameter) {
                CHECK((p - evaluate(s.curve, t)).norm() <= 1000 * bound);
            } else {
                CHECK(distance_mm(s.curve, p) <= 1000 * bound);
            }
        }
    }
}

TEST_CASE("5: a circle has nine control points and is a circle") {
    Random random(21);
    for (int i = 0; i < 100; ++i) {
        const Circle circle{random.frame(), random.between(0.1, 80)};
        const double from = random.between(-7, 7);
        const BSplineCurve c = rational(circle, from, from + 2 * pi);
        CHECK(c.control_points.size() == 9);
        CHECK(c.closed);
        for (double t = from; t < from + 2 * pi; t += 0.1) {
            const Point3 local = circle.frame.to_local(evaluate(c, t));
            CHECK(std::abs(local.z()) <= construction_round_off_mm);
            CHECK(std::abs(std::hypot(local.x(), local.y()) - circle.radius_mm) <=
                  construction_round_off_mm);
        }
    }
}

TEST_CASE("5: a piece of a closed B-spline may cross its seam") {
    Random random(22);
    for (int i = 0; i < 100; ++i) {
        const Circle circle{random.frame(), random.between(0.1, 80)};
        const BSplineCurve whole = rational(circle, 0, 2 * pi);
        const double from = random.between(-9, 9), to = from + random.between(0.1, 2 * pi);
        const BSplineCurve c = rational(whole, from, to);
        for (int k = 0; k <= 10; ++k) {
            const double t = c.domain_start() + k / 10.0 * (c.domain_end() - c.domain_start());
            CHECK((evaluate(c, t) - evaluate(whole, t)).norm() <= construction_round_off_mm);
        }
    }
}

TEST_CASE("5: an extrusion is its curve, moved") {
    Random random(23);
    for (int i = 0; i < 500; ++i) {
        const BSplineCurve c = test::random_spline(random);
        const Vector3 sweep = random.vector(20);
        const BSplineSurface s = extruded(c, sweep);
        CHECK(s.closed_u == c.closed);
        for (int k = 0; k < 5; ++k) {
            const double u = random.between(s.start_u(), s.end_u()), v = random.between(0, 1);
            CHECK((evaluate(s, {u, v}) - evaluate(c, u) - v * sweep).norm() <=
                  construction_round_off_mm);
            const Partials at = partials(s, {u, v});
            CHECK((at.dv - sweep).norm() <= 1e-11);
            CHECK((at.du - derivative(c, u)).norm() <= 1e-9 * (1 + at.du.norm()));
        }
    }
}

TEST_CASE("5: a revolution keeps heights and distances from the axis") {
    Random random(24);
    for (int i = 0; i < 500; ++i) {
        const BSplineCurve c = test::random_spline(random);
        const Frame axis = random.frame();
        const BSplineSurface s = revolved(c, axis);
        CHECK(s.closed_u);
        for (int k = 0; k < 5; ++k) {
            const double v = random.between(s.start_v(), s.end_v());
            const Point3 profile = axis.to_local(evaluate(c, v));
            const Point3 p = axis.to_local(evaluate(s, {random.between(-9, 9), v}));
            const double radius = std::hypot(profile.x(), profile.y());
            CHECK(std::abs(p.z() - profile.z()) <= construction_round_off_mm);
            CHECK(std::abs(std::hypot(p.x(), p.y()) - radius) <= construction_round_off_mm);
            // A quarter of a turn is where it should be, from x towards y.
            const Point3 quarter = axis.to_local(evaluate(s, {pi / 2, v}));
            CHECK((quarter - Point3(-profile.y(), profile.x(), profile.z())).norm() <=
                  construction_round_off_mm);
        }
    }
}

TEST_CASE("4: at the poles of a turned sphere the normal is radial, and points are found there") {
    Random random(25);
    for (int i = 0; i < 200; ++i) {
        const double radius_mm = random.between(0.1, 50);
        const Frame axis = random.frame();
        const Frame meridian{axis.origin, axis.x, axis.z, axis.x.cross(axis.z)};
        const BSplineSurface s =
            revolved(rational(Circle{meridian, radius_mm}, -pi / 2, pi / 2), axis);
        const double handed = axis.x.cross(axis.y).dot(axis.z);
        for (const double v : {s.start_v(), s.start_v() + 1e-9, 0.3, s.end_v() - 1e-7, s.end_v()}) {
            const Point2 uv(random.between(0, 2 * pi), v);
            const Point3 p = evaluate(s, uv);
            const Vector3 radial = (p - axis.origin).normalized();
            CHECK((p - axis.origin).norm() == doctest::Approx(radius_mm).epsilon(1e-12));
            CHECK((normal(s, uv) - handed * radial).norm() <= 1e-6);
            CHECK((evaluate(s, invert(s, p)) - p).norm() <= resolution_mm);
            const Point3 off = p + 0.1 * radius_mm * radial;
            CHECK((evaluate(s, invert(s, off)) - p).norm() <= 1e-3 * radius_mm);
            CHECK((evaluate(s, invert_near(s, p, {uv.x() + 2, v})) - p).norm() <= resolution_mm);
        }
        // Every point is as near: any will do, but it must be found in time.
        const Point3 nearest = evaluate(s, invert(s, axis.origin));
        CHECK((nearest - axis.origin).norm() == doctest::Approx(radius_mm).epsilon(1e-9));
    }
}

TEST_CASE("3: on a sheet with kinks a point beyond one is found from a guess before it") {
    Random random(26);
    for (int i = 0; i < 200; ++i) {
        BSplineCurve zigzag{1, {0}, {}, {}, false};
        for (int k = 0; k < 8; ++k) {
            zigzag.knots.push_back(k);
            zigzag.control_points.emplace_back(10.0 * k, k % 2 == 0 ? 0.0 : 3.0, 0.0);
        }
        zigzag.knots.push_back(7);
        const BSplineSurface s = extruded(zigzag, {0, 0, 20});
        const Point2 uv(random.between(0, 7), random.between(0, 1));
        const Point3 p = evaluate(s, uv);
        const Point2 guess(random.between(0, 7), random.between(0, 1));
        CHECK((evaluate(s, invert(s, p)) - p).norm() <= resolution_mm);
        CHECK((invert_near(s, p, guess) - uv).norm() <= 1e-6);
    }
}

TEST_CASE("reversed, raised and joined curves are the same points") {
    Random random(27);
    for (int i = 0; i < 500; ++i) {
        const BSplineCurve c = test::random_spline(random);
        const double start = c.domain_start(), end = c.domain_end();
        const BSplineCurve back = reversed(c);
        const BSplineCurve raised = elevated(c, c.degree + random.integer(0, 3));
        CHECK(back.domain_start() == doctest::Approx(start).epsilon(1e-12));
        CHECK(raised.domain_end() == end);
        const double middle = random.between(start, end);
        const BSplineCurve both = joined(rational(c, start, middle), rational(c, middle, end));
        for (int k = 0; k < 5; ++k) {
            const double t = random.between(start, end);
            const Point3 p = evaluate(c, t);
            CHECK((evaluate(back, start + end - t) - p).norm() <= 1e-9);
            CHECK((evaluate(raised, t) - p).norm() <= 1e-9);
            CHECK((evaluate(both, t) - p).norm() <= 1e-9);
        }
    }
}
