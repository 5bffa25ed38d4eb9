#include <doctest/doctest.h>

#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Checks that the edge runs from one vertex to the other and is as long as it should be.
void check_edge(const Curve& curve, const Point3& a, const Point3& b, bool same_sense,
                double length_mm) {
    Model model;
    model.vertices = {{a, 1}, {b, 2}};
    const bool closed = (a - b).norm() == 0;
    Diagnostics problems;
    const Edge edge = make_edge(curve, VertexId{0}, VertexId{closed ? 0u : 1u}, same_sense, 7,
                                model, 0, problems);
    CHECK(problems.empty());
    CHECK((evaluate(curve, edge.t_start) - a).norm() < 1e-9);
    CHECK((evaluate(curve, edge.t_end) - b).norm() < 1e-9);
    CHECK((edge.t_end > edge.t_start) == same_sense);
    double length = 0;
    constexpr int steps = 2000;
    Point3 before = a;
    for (int i = 1; i <= steps; ++i) {
        const Point3 here = evaluate(curve, edge.t_start + (edge.t_end - edge.t_start) * i / steps);
        length += (here - before).norm();
        before = here;
    }
    CHECK(length == doctest::Approx(length_mm).epsilon(1e-5));
}

BSplineCurve circle_as_spline(double r, bool closed) {
    const double w = std::sqrt(0.5);
    BSplineCurve curve{2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, {}, {}, closed};
    const double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    for (int i = 0; i < 9; ++i) {
        curve.control_points.emplace_back(r * x[i], r * y[i], 0);
        curve.weights.push_back(i % 2 ? w : 1);
    }
    return curve;
}

}  // namespace

TEST_CASE("edge builder: an arc goes the way its sense says, over the start of the parameter too") {
    const Circle circle{Builder::frame_at({0, 0, 0}), 2};
    const auto on = [](double a) { return Point3(2 * std::cos(a), 2 * std::sin(a), 0); };
    for (const double a : {0.0, 1.0, 3.0, -2.0}) {
        for (const double turn : {0.5, 2.0, 5.0}) {
            check_edge(circle, on(a), on(a + turn), true, 2 * turn);
            check_edge(circle, on(a + turn), on(a), false, 2 * turn);
        }
        check_edge(circle, on(a), on(a), true, 4 * pi);
        check_edge(circle, on(a), on(a), false, 4 * pi);
    }
}

TEST_CASE("edge builder: a line runs between its vertices in either sense") {
    const Line line{{1, 1, 1}, {1, 0, 0}};
    check_edge(line, {2, 1, 1}, {5, 1, 1}, true, 3);
    check_edge(line, {5, 1, 1}, {2, 1, 1}, false, 3);
}

TEST_CASE("edge builder: a spline that comes back to its start, declared closed or not") {
    for (const bool closed : {true, false}) {
        const Curve curve = circle_as_spline(3, closed);
        check_edge(curve, {3, 0, 0}, {3, 0, 0}, true, 6 * pi);
        check_edge(curve, {3, 0, 0}, {3, 0, 0}, false, 6 * pi);
        check_edge(curve, {3, 0, 0}, {-3, 0, 0}, true, 3 * pi);
        check_edge(curve, {-3, 0, 0}, {3, 0, 0}, true, 3 * pi);
        check_edge(curve, {3, 0, 0}, {0, 3, 0}, false, 4.5 * pi);
    }
}

TEST_CASE("edge builder: a vertex off its curve is reported with edge, vertex and place") {
    Model model;
    model.vertices = {{{0, 0, 0}, 11}, {{5, 0.1, 0}, 12}};
    Diagnostics problems;
    make_edge(Line{{0, 0, 0}, {1, 0, 0}}, VertexId{0}, VertexId{1}, true, 7, model, 0.01, problems);
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].where.entity == 7);
    CHECK(problems[0].message.find("#12") != std::string::npos);
    CHECK(problems[0].where.x_mm == 5);
}
