#include "kernel/contour/fit.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace lyr;

namespace {

using std::numbers::pi;

PlaneCurve ellipse(double a, double b) {
    return [=](double t) {
        return CurvePoint{{a * std::cos(t), b * std::sin(t)},
                          Vector2(-a * std::sin(t), b * std::cos(t)).normalized()};
    };
}

PlaneCurve hyperbola(double a, double b) {
    return [=](double t) {
        return CurvePoint{{a * std::cosh(t), b * std::sinh(t)},
                          Vector2(a * std::sinh(t), b * std::cosh(t)).normalized()};
    };
}

// An inflection in the middle.
PlaneCurve sine() {
    return [](double t) {
        return CurvePoint{{t, std::sin(t)}, Vector2(1, std::cos(t)).normalized()};
    };
}

struct Fitted {
    std::vector<Segment> arcs;
    double worst_mm = 0, worst_turn = 0;
};

Fitted fit(const PlaneCurve& curve, double from, double to, double allowed_mm) {
    Fitted result;
    const Point2 start = curve(from).point, end = curve(to).point;
    fit_arcs(curve, from, to, start, end, allowed_mm, result.arcs);
    constexpr int samples = 20000;
    for (int i = 0; i <= samples; ++i) {
        const Point2 point = curve(from + (to - from) * i / samples).point;
        Point2 at = start;
        double off = 1e9;
        for (const Segment& arc : result.arcs) {
            off = std::min(off, distance_mm(at, arc, point));
            at = arc.end;
        }
        result.worst_mm = std::max(result.worst_mm, off);
    }
    CHECK((result.arcs.back().end - end).norm() == 0);
    Point2 at = start;
    Vector2 tangent = curve(from).tangent;
    for (const Segment& arc : result.arcs) {
        const Vector2 leaving = start_tangent(at, arc);
        result.worst_turn = std::max(result.worst_turn, (leaving - tangent).norm());
        tangent = end_tangent(at, arc);
        at = arc.end;
    }
    result.worst_turn = std::max(result.worst_turn, (tangent - curve(to).tangent).norm());
    return result;
}

}  // namespace

TEST_CASE("fit 1, 2: arcs share tangents and stay within the bound everywhere") {
    for (const double allowed_mm : {0.05, 0.0025, 0.0001}) {
        for (const auto& [curve, from, to] : {std::tuple{ellipse(5, 4), 0.3, 4.5},
                                              {ellipse(50, 1), 0.0, 2 * pi},
                                              {ellipse(1, 1000), -1.0, 3.0},
                                              {hyperbola(2, 1), -3.0, 3.0},
                                              {hyperbola(0.001, 1), -4.0, 4.0},
                                              {sine(), 0.0, 9.0}}) {
            const Fitted fitted = fit(curve, from, to, allowed_mm);
            CHECK(fitted.worst_mm <= allowed_mm);
            CHECK(fitted.worst_turn < 1e-6);
        }
    }
}

TEST_CASE(
    "fit 3: a circle takes few arcs and a curve's arcs grow with the cube root of the bound") {
    CHECK(fit(ellipse(3, 3), 0, 2 * pi, 0.001).arcs.size() <= 12);
    const auto coarse = fit(ellipse(50, 20), 0, 2 * pi, 0.008).arcs.size();
    const auto fine = fit(ellipse(50, 20), 0, 2 * pi, 0.001).arcs.size();
    CHECK(fine <= 2 * coarse + 4);
}

TEST_CASE("fit: a corner that no arc can follow is passed, not looped on") {
    const PlaneCurve corner = [](double t) {
        return t < 0 ? CurvePoint{{t, 0}, {1, 0}} : CurvePoint{{0, t}, {0, 1}};
    };
    std::vector<Segment> arcs;
    fit_arcs(corner, -1, 1, {-1, 0}, {0, 1}, 0.001, arcs);
    CHECK(arcs.size() < 200);
    Point2 at(-1, 0);
    double off = 1e9;
    for (const Segment& arc : arcs) {
        off = std::min(off, distance_mm(at, arc, {0, 0}));
        at = arc.end;
    }
    CHECK(off <= 0.001);
}

TEST_CASE("fit: a span of a few bits of the parameter ends") {
    const PlaneCurve curve = ellipse(5, 4);
    for (double to = 1, i = 0; i < 20; ++i) {
        to = std::nextafter(to, 2);
        // Ends off the curve by more than the bound, as a model with loose edges has them.
        for (const double off : {0.0, 1e-9, 0.01}) {
            std::vector<Segment> arcs;
            const Point2 end = curve(to).point + Vector2(off, off);
            fit_arcs(curve, 1, to, curve(1).point, end, 0.001, arcs);
            REQUIRE(!arcs.empty());
            CHECK(arcs.size() < 200);
            CHECK((arcs.back().end - end).norm() == 0);
        }
    }
}

namespace {

// How many arcs are needed at least for a quarter of an ellipse, tangent-continuous or not. Where the curvature
// changes by k' a length, a circle over the length l stays k' l^3 / 192 off at best: the Chebyshev cubic.
double least_arcs(double a, double b, double allowed_mm) {
    const auto speed = [&](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); };
    const auto curvature = [&](double t) { return a * b / std::pow(speed(t), 3); };
    constexpr int steps = 100000;
    const double h = pi / 2 / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) * h;
        const double change = (curvature(t + h / 2) - curvature(t - h / 2)) / (h * speed(t));
        sum += std::cbrt(std::abs(change) / (192 * allowed_mm)) * speed(t) * h;
    }
    return sum;
}

}  // namespace

TEST_CASE("fit 3: at most 1.4 times as many arcs as any arcs need, and one for the ends") {
    for (const auto& [a, b] :
         {std::pair(40.0, 15.0), std::pair(100.0, 80.0), std::pair(5.0, 4.0)}) {
        for (const double allowed_mm : {0.0025, 0.00025}) {
            CAPTURE(a);
            CAPTURE(allowed_mm);
            const PlaneCurve curve = ellipse(a, b);
            const double least = least_arcs(a, b, allowed_mm);
            std::vector<Segment> direct, through_points;
            fit_arcs(curve, 0, pi / 2, curve(0).point, curve(pi / 2).point, allowed_mm, direct);
            std::vector<CurvePoint> points;
            for (int i = 0; i <= 4000; ++i) points.push_back(curve(pi / 2 * i / 4000));
            fit_arcs(points, allowed_mm, through_points);
            MESSAGE("arcs: " << direct.size() << ", through points " << through_points.size()
                             << ", at least " << least);
            CHECK(static_cast<double>(direct.size()) <= 1.4 * least + 1);
            CHECK(static_cast<double>(through_points.size()) <= 1.4 * least + 1);
            CHECK(static_cast<double>(direct.size()) >= least);
        }
    }
}

namespace {

// An arc of a radius that turns left by an angle, a line along x, and such an arc again; the line begins at the origin.
PlaneCurve arc_line_arc(double radius, double line_mm, double turn_rad) {
    return [=](double t) {
        const auto on_arc = [&](double angle, double x) {
            return CurvePoint{{x + radius * std::sin(angle), radius * (1 - std::cos(angle))},
                              {std::cos(angle), std::sin(angle)}};
        };
        const double arc_mm = radius * turn_rad;
        if (t < arc_mm) return on_arc((t - arc_mm) / radius, 0);
        if (t < arc_mm + line_mm) return CurvePoint{{t - arc_mm, 0}, {1, 0}};
        return on_arc((t - arc_mm - line_mm) / radius, line_mm);
    };
}

}  // namespace

TEST_CASE("fit 2: arcs do not leave out the tip of a curve that comes back the way it went") {
    CHECK(fit(ellipse(50, 0.001), -2, 2, 0.0025).worst_mm <= 0.0025);
    const PlaneCurve thin = hyperbola(19.2, 0.0187);
    CHECK(fit(thin, -1, 1, 0.0016).worst_mm <= 0.0016);
    std::vector<CurvePoint> points;
    for (int i = 0; i <= 800; ++i) points.push_back(ellipse(50, 0.001)(-2 + 0.005 * i));
    std::vector<Segment> arcs;
    fit_arcs(points, 0.0025, arcs);
    for (const CurvePoint& p : points) {
        Point2 at = points.front().point;
        double off = 1e9;
        for (const Segment& arc : arcs) {
            off = std::min(off, distance_mm(at, arc, p.point));
            at = arc.end;
        }
        CHECK(off <= 0.0025);
    }
}

TEST_CASE(
    "fit 1, 2: long lines between arcs are kept to, and no search for few arcs ends in a kink") {
    for (const double radius : {0.1, 1.0, 5.0}) {
        for (const double line_mm : {1.0, 10.0, 30.0}) {
            for (const double turn : {0.3, 0.7, 2.5}) {
                for (const double allowed_mm : {0.0005, 0.0025}) {
                    CAPTURE(radius);
                    CAPTURE(line_mm);
                    CAPTURE(turn);
                    CAPTURE(allowed_mm);
                    const PlaneCurve curve = arc_line_arc(radius, line_mm, turn);
                    const Fitted fitted = fit(curve, 0, 2 * radius * turn + line_mm, allowed_mm);
                    CHECK(fitted.worst_mm <= allowed_mm);
                    CHECK(fitted.worst_turn < 1e-4);
                }
            }
        }
    }
}

TEST_CASE("fit 2: a curve that bends both ways about the middle of a span is kept to") {
    const PlaneCurve cubic = [](double t) {
        return CurvePoint{{t, t * t * t}, Vector2(1, 3 * t * t).normalized()};
    };
    CHECK(fit(cubic, -3, 3, 0.0001).worst_mm <= 0.0001);
}

TEST_CASE("fit: a curve that dwells, is rough, has a wrong tangent or none, ends soon") {
    std::size_t calls = 0;
    const auto counted = [&](const PlaneCurve& curve) {
        return [&calls, curve](double t) {
            ++calls;
            return curve(t);
        };
    };
    const PlaneCurve round = ellipse(5, 4);
    const auto bad = [](double t) { return t > 1 && t < 1.1; };
    for (const PlaneCurve& curve :
         {PlaneCurve([&](double t) { return round(bad(t) ? 1 : t); }), PlaneCurve([&](double t) {
              return CurvePoint{round(t).point, (bad(t) ? -1 : 1) * round(t).tangent};
          }),
          PlaneCurve([&](double t) {
              return CurvePoint{round(t).point, (bad(t) ? 0 : 1) * round(t).tangent};
          }),
          PlaneCurve([&](double t) {
              return bad(t) ? CurvePoint{{NAN, NAN}, {NAN, NAN}} : round(t);
          }),
          PlaneCurve([&](double t) {
              return CurvePoint{
                  round(t).point + 1e-5 * Vector2(std::sin(1e7 * t), std::cos(3e7 * t)),
                  round(t).tangent};
          })}) {
        calls = 0;
        std::vector<Segment> arcs;
        fit_arcs(counted(curve), 0, 2, round(0).point, round(2).point, 1e-4, arcs);
        CHECK(calls < 10'000'000);
        CHECK(arcs.back().end == round(2).point);
    }
}
