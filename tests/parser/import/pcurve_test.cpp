// Edges of which only a curve in the parameters of a surface is known: the contract in parser/import/pcurve.h.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "checks.h"
#include "kernel/geometry/bspline_surface.h"

using namespace lyr;
using namespace lyr::test;

namespace {

using Write = std::function<int(StepText&)>;

int flat_point(StepText& step, double u, double v) {
    return step.add("CARTESIAN_POINT('',(" + StepText::num(u) + "," + StepText::num(v) + "))");
}

Write flat_line(double u, double v, double along_u, double along_v) {
    return [=](StepText& step) {
        const int at = flat_point(step, u, v);
        const int direction = step.add("DIRECTION('',(" + StepText::num(along_u) + "," +
                                       StepText::num(along_v) + "))");
        const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",1.)");
        return step.add("LINE(''," + StepText::ref(at) + "," + StepText::ref(vector) + ")");
    };
}

Write flat_spline(const std::vector<Point2>& points, const std::string& tail) {
    return [=](StepText& step) {
        std::vector<int> ids;
        for (const Point2& p : points) ids.push_back(flat_point(step, p.x(), p.y()));
        return step.add("B_SPLINE_CURVE_WITH_KNOTS('',2," + StepText::refs(ids) +
                        ",.UNSPECIFIED.,.F.,.U.," + tail + ",.UNSPECIFIED.)");
    };
}

Write surface(const std::string& type, const std::string& sizes) {
    return [=](StepText& step) {
        const int at = step.placement({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX());
        return step.add(type + "(''," + StepText::ref(at) + sizes + ")");
    };
}

// A face whose first edge is a curve of the surface's parameters, from `start` to `end`.
StepText face_step(const Write& on, const Write& flat, const Point3& start, const Point3& end,
                   bool in_degrees) {
    StepText step;
    const int basis = on(step);
    const int context =
        step.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)REPRESENTATION_CONTEXT('',''))");
    const int representation =
        step.add("DEFINITIONAL_REPRESENTATION(''," + StepText::refs({flat(step)}) + "," +
                 StepText::ref(context) + ")");
    const int pcurve =
        step.add("PCURVE(''," + StepText::ref(basis) + "," + StepText::ref(representation) + ")");
    const int a = step.vertex(start), b = step.vertex(end);
    const int edge = step.edge(a, b, pcurve), back = step.edge(b, a, step.line(end, start));
    const int face = step.face(
        {step.bound(step.loop({step.oriented(edge, true), step.oriented(back, true)}))}, basis);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    const int units =
        step.context({step.si_length(".MILLI."), in_degrees ? step.degree() : step.radian()});
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")}, units);
    return step;
}

Edge edge_on(const Write& on, const Write& flat, const Point3& start, const Point3& end,
             bool in_degrees = false) {
    const Imported result = imported(face_step(on, flat, start, end, in_degrees));
    CHECK(result.diagnostics.empty());
    const Edge edge = result.model.edges.at(0);
    CHECK(near(evaluate(edge.curve, edge.t_start), start));
    CHECK(near(evaluate(edge.curve, edge.t_end), end));
    return edge;
}

Point3 middle(const Edge& edge) {
    return evaluate(edge.curve, 0.5 * (edge.t_start + edge.t_end));
}

}  // namespace

TEST_CASE("1: any curve on a plane") {
    const Write plane = surface("PLANE", "");
    const Edge line = edge_on(plane, flat_line(0, 0, 3, 4), {1, 2, 3}, {4, 6, 3});
    CHECK(std::holds_alternative<Line>(line.curve));
    const Write circle = [](StepText& step) {
        const int at =
            step.add("AXIS2_PLACEMENT_2D(''," + StepText::ref(flat_point(step, 5, 0)) + ",$)");
        return step.add("CIRCLE(''," + StepText::ref(at) + ",2.)");
    };
    const Edge arc = edge_on(plane, circle, {8, 2, 3}, {4, 2, 3});
    CHECK(std::get<Circle>(arc.curve).radius_mm == doctest::Approx(2));
    CHECK(near(middle(arc), {6, 4, 3}));
    const Edge spline = edge_on(plane, flat_spline({{0, 0}, {2, 4}, {4, 0}}, "(3,3),(0.,1.)"),
                                {1, 2, 3}, {5, 2, 3});
    CHECK(near(middle(spline), {3, 4, 3}));
}

TEST_CASE("1: lines along one parameter") {
    const Write cylinder = surface("CYLINDRICAL_SURFACE", ",2.");
    const Edge ruling = edge_on(cylinder, flat_line(0, 0, 0, -1), {3, 2, 3}, {3, 2, -4});
    CHECK(std::holds_alternative<Line>(ruling.curve));
    const Edge quarter = edge_on(cylinder, flat_line(0, 1, 1, 0), {3, 2, 4}, {1, 4, 4});
    CHECK(near(middle(quarter), {1 + std::sqrt(2), 2 + std::sqrt(2), 4}));
    // Against the angle: the long way round.
    const Edge rest = edge_on(cylinder, flat_line(0, 1, -1, 0), {3, 2, 4}, {1, 4, 4});
    CHECK(near(middle(rest), {1 - std::sqrt(2), 2 - std::sqrt(2), 4}));
    const Edge degrees = edge_on(cylinder, flat_line(90, 0, 0, 1), {1, 4, 3}, {1, 4, 9}, true);
    CHECK(std::holds_alternative<Line>(degrees.curve));

    const double slope = std::tan(0.5);
    const Write cone = surface("CONICAL_SURFACE", ",2.,0.5");
    const Edge side = edge_on(cone, flat_line(0, 0, 0, 1), {3, 2, 3}, {3 + 4 * slope, 2, 7});
    CHECK(std::holds_alternative<Line>(side.curve));
    const double wide = 2 + slope;
    const Edge ring = edge_on(cone, flat_line(0, 1, 1, 0), {1 + wide, 2, 4}, {1 - wide, 2, 4});
    CHECK(near(middle(ring), {1, 2 + wide, 4}));

    const Write sphere = surface("SPHERICAL_SURFACE", ",2.");
    const Edge meridian = edge_on(sphere, flat_line(0, 0, 0, 1), {3, 2, 3}, {1, 2, 5});
    CHECK(near(middle(meridian), {1 + std::sqrt(2), 2, 3 + std::sqrt(2)}));
    const double c = 2 * std::cos(0.3), s = 2 * std::sin(0.3);
    const Edge parallel =
        edge_on(sphere, flat_line(0, 0.3, 1, 0), {1 + c, 2, 3 + s}, {1 - c, 2, 3 + s});
    CHECK(near(middle(parallel), {1, 2 + c, 3 + s}));

    const Write torus = surface("TOROIDAL_SURFACE", ",5.,2.");
    const Edge tube = edge_on(torus, flat_line(0, 0, 0, 1), {8, 2, 3}, {4, 2, 3});
    CHECK(near(middle(tube), {6, 2, 5}));
    const Edge around = edge_on(torus, flat_line(0, 0, 1, 0), {8, 2, 3}, {-6, 2, 3});
    CHECK(near(middle(around), {1, 9, 3}));
}

TEST_CASE("1: lines along one parameter of a B-spline surface") {
    const std::vector<std::vector<Point3>> net{{{0, 0, 0}, {0, 1, 0}, {0, 2, 1}},
                                               {{3, 0, 2}, {3, 1, 4}, {3, 2, 0}}};
    const std::vector<double> weights{1, 2, 1, 1, 0.5, 1};
    BSplineSurface kernel{1, 2, 2, 3, {0, 0, 1, 1}, {0, 0, 0, 1, 1, 1}, {}, weights};
    for (const auto& row : net)
        kernel.control_points.insert(kernel.control_points.end(), row.begin(), row.end());
    const Write spline = [&](StepText& step) {
        std::string text = "(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,2,(";
        for (std::size_t i = 0; i < 2; ++i) {
            std::vector<int> ids;
            for (const Point3& p : net[i]) ids.push_back(step.point(p));
            if (i > 0) text += ',';
            text += StepText::refs(ids);
        }
        return step.add(text +
                        "),.UNSPECIFIED.,.F.,.F.,.F.)BEZIER_SURFACE()"
                        "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,2.,1."
                        "),(1.,0.5,1.)))REPRESENTATION_ITEM('')SURFACE())");
    };
    const Edge along_v = edge_on(spline, flat_line(0.25, 0, 0, 1), evaluate(kernel, {0.25, 0}),
                                 evaluate(kernel, {0.25, 1}));
    CHECK(near(middle(along_v), evaluate(kernel, {0.25, 0.5})));
    const Edge along_u = edge_on(spline, flat_line(1, 0.75, -1, 0), evaluate(kernel, {1, 0.75}),
                                 evaluate(kernel, {0, 0.75}));
    CHECK(near(middle(along_u), evaluate(kernel, {0.5, 0.75})));
}

TEST_CASE("2: other curves to within a quarter of the resolution") {
    // A turn and a half up a cylinder, by a spline of degree 2 with a corner in the middle.
    const Write cylinder = surface("CYLINDRICAL_SURFACE", ",2.");
    const std::vector<Point2> points{{0, 0}, {1, 2}, {3, 2}, {4, 8}, {9, 8}};
    const auto flat = [&](double t) -> Point2 {
        const std::size_t first = t < 1 ? 0 : 2;
        const double s = t < 1 ? t : t - 1, r = 1 - s;
        return r * r * points[first] + 2 * r * s * points[first + 1] + s * s * points[first + 2];
    };
    const auto lifted = [&](const Point2& uv) -> Point3 {
        return {1 + 2 * std::cos(uv.x()), 2 + 2 * std::sin(uv.x()), 3 + uv.y()};
    };
    const Edge edge = edge_on(cylinder, flat_spline(points, "(3,2,3),(0.,1.,2.)"),
                              lifted(points.front()), lifted(points.back()));
    CHECK(std::get<BSplineCurve>(edge.curve).degree == 3);
    CHECK(edge.t_start == 0);
    CHECK(edge.t_end == 2);
    for (int i = 0; i <= 1000; ++i) {
        const double t = i / 500.0;
        CHECK((evaluate(edge.curve, t) - lifted(flat(t))).norm() <= resolution_mm / 4);
    }
}

TEST_CASE("3: what has no ends or no parameters of the standard is named") {
    const Diagnostic helix = refused(face_step(surface("CYLINDRICAL_SURFACE", ",2."),
                                               flat_line(0, 0, 1, 1), {3, 2, 3}, {1, 4, 9}, false));
    CHECK(helix.status == ExitStatus::unsupported);
    CHECK(mentions(helix, "PCURVE #"));
    const Diagnostic cone = refused(face_step(surface("CONICAL_SURFACE", ",2.,-0.5"),
                                              flat_line(0, 0, 0, 1), {3, 2, 3}, {1, 4, 9}, false));
    CHECK(cone.status == ExitStatus::unsupported);
    CHECK(mentions(cone, "CONICAL_SURFACE #"));
}
