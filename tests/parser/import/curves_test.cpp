// Curves in all forms that files state them in, by the numbers of the contract in parser/import/curves.h.

#include <doctest/doctest.h>

#include <functional>

#include "checks.h"
#include "flat_curves.h"

using namespace lyr;
using namespace lyr::test;

namespace {

// A disc on z = 0 whose rim is the curve that `curve` writes, from `start` to `end` and straight back.
Edge edge_on(const std::function<int(StepText&)>& curve, const Point3& start, const Point3& end,
             bool same_sense, Diagnostics* diagnostics = nullptr) {
    StepText step;
    const int a = step.vertex(start), b = step.vertex(end);
    const int edge = step.edge(a, b, curve(step), same_sense);
    const int back = step.edge(b, a, step.line(end, start));
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int plane = step.add("PLANE(''," + StepText::ref(at) + ")");
    const int up = step.face(
        {step.bound(step.loop({step.oriented(edge, true), step.oriented(back, true)}))}, plane);
    const int down =
        step.face({step.bound(step.loop({step.oriented(back, false), step.oriented(edge, false)}))},
                  plane, false);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({up, down}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Imported result = imported(step);
    if (diagnostics) *diagnostics = result.diagnostics;
    const Edge found = result.model.edges.at(0);
    CHECK(near(evaluate(found.curve, found.t_start), start));
    CHECK(near(evaluate(found.curve, found.t_end), end));
    return found;
}

std::string points(StepText& step, const std::vector<Point3>& list) {
    std::vector<int> ids;
    for (const Point3& p : list) ids.push_back(step.point(p));
    return StepText::refs(ids);
}

const std::vector<Point3> arch{{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}};

int circle(StepText& step) {
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    return step.add("CIRCLE(''," + StepText::ref(at) + ",2.)");
}

}  // namespace

TEST_CASE("1, 2: a circle's sense says which of two arcs is meant") {
    const double r = std::sqrt(2.0);
    CHECK(near(middle(edge_on(circle, {2, 0, 0}, {0, 2, 0}, true)), {r, r, 0}));
    CHECK(near(middle(edge_on(circle, {2, 0, 0}, {0, 2, 0}, false)), {-r, -r, 0}));
    const auto trimmed = [](bool agrees) {
        return [agrees](StepText& step) {
            const int basis = circle(step);
            return step.add("TRIMMED_CURVE(''," + StepText::ref(basis) +
                            ",(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(" + "1.5707963))," +
                            StepText::flag(agrees) + ",.PARAMETER.)");
        };
    };
    CHECK(near(middle(edge_on(trimmed(true), {2, 0, 0}, {0, 2, 0}, true)), {r, r, 0}));
    CHECK(near(middle(edge_on(trimmed(false), {2, 0, 0}, {0, 2, 0}, true)), {-r, -r, 0}));
    CHECK(near(middle(edge_on(trimmed(false), {2, 0, 0}, {0, 2, 0}, false)), {r, r, 0}));
}

TEST_CASE("1: curves on surfaces count by their curve in space") {
    for (const std::string type : {"SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE"}) {
        const auto on_surface = [&](StepText& step) {
            const int in_space = circle(step);
            return step.add(type + "(''," + StepText::ref(in_space) + ",(),.CURVE_3D.)");
        };
        const Edge edge = edge_on(on_surface, {2, 0, 0}, {0, 2, 0}, true);
        CHECK(std::holds_alternative<Circle>(edge.curve));
    }
}

TEST_CASE("1: conics") {
    const auto conic = [](const std::string& type, const std::string& sizes) {
        return [=](StepText& step) {
            const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
            return step.add(type + "(''," + StepText::ref(at) + "," + sizes + ")");
        };
    };
    CHECK(near(middle(edge_on(conic("ELLIPSE", "3.,1."), {3, 0, 0}, {-3, 0, 0}, true)), {0, 1, 0}));
    CHECK(near(middle(edge_on(conic("PARABOLA", "0.5"), {2, -2, 0}, {2, 2, 0}, true)), {0, 0, 0}));
    const double c = std::cosh(1.0), s = std::sinh(1.0);
    CHECK(near(
        middle(edge_on(conic("HYPERBOLA", "2.,3."), {2 * c, -3 * s, 0}, {2 * c, 3 * s, 0}, true)),
        {2, 0, 0}));
}

TEST_CASE("1, 3: B-splines in every form") {
    const std::string tail = ",.UNSPECIFIED.,.F.,.U.";
    const auto simple = [&](const std::string& type, const std::string& knots) {
        return edge_on(
            [&](StepText& step) {
                return step.add(type + "('',3," + points(step, arch) + tail + knots + ")");
            },
            arch.front(), arch.back(), true);
    };
    CHECK(near(middle(simple("B_SPLINE_CURVE_WITH_KNOTS", ",(4,4),(0.,5.),.UNSPECIFIED.")),
               {1, 1.5, 0}));
    CHECK(near(middle(simple("BEZIER_CURVE", "")), {1, 1.5, 0}));
    CHECK(near(middle(simple("QUASI_UNIFORM_CURVE", "")), {1, 1.5, 0}));
    // Weights 1, 3, 3, 1 pull the arch up: (0 + 9*2 + 9*2 + 0) / (1 + 9 + 9 + 1).
    const std::string forms[] = {"B_SPLINE_CURVE_WITH_KNOTS((4,4),(0.,1.),.UNSPECIFIED.)",
                                 "BEZIER_CURVE()", "QUASI_UNIFORM_CURVE()"};
    for (const std::string& form : forms) {
        const Edge edge = edge_on(
            [&](StepText& step) {
                return step.add(
                    "(BOUNDED_CURVE()B_SPLINE_CURVE(3," + points(step, arch) + tail + ")" + form +
                    "CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE((1.,3.,3.,1.))" +
                    "REPRESENTATION_ITEM(''))");
            },
            arch.front(), arch.back(), true);
        CHECK(near(middle(edge), {1, 1.8, 0}));
    }
    // A uniform cubic starts inside its control polygon: at (1, 4, 1) / 6.
    const Point3 start = (arch[0] + 4 * arch[1] + arch[2]) / 6,
                 end = (arch[1] + 4 * arch[2] + arch[3]) / 6;
    const Edge uniform = edge_on(
        [&](StepText& step) {
            return step.add("UNIFORM_CURVE('',3," + points(step, arch) + tail + ")");
        },
        start, end, true);
    CHECK(middle(uniform).x() == doctest::Approx(1));
    const Edge polyline =
        edge_on([&](StepText& step) { return step.add("POLYLINE(''," + points(step, arch) + ")"); },
                arch.front(), arch.back(), true);
    CHECK(near(middle(polyline), {1, 2, 0}));
}

TEST_CASE("3: a closed spline is one by its ends, not by its flag") {
    const std::vector<Point3> ring{{1, 0, 0}, {2, 2, 0}, {-2, 2, 0}, {-1, -3, 0}, {1, 0, 0}};
    StepText step;
    const int curve = step.add("B_SPLINE_CURVE_WITH_KNOTS('',4," + points(step, ring) +
                               ",.UNSPECIFIED.,.F.,.U.,(5,5),(0.,1.),.UNSPECIFIED.)");
    const int v = step.vertex(ring.front());
    const int rim = step.edge(v, v, curve);
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int plane = step.add("PLANE(''," + StepText::ref(at) + ")");
    const int up = step.face({step.bound(step.loop({step.oriented(rim, true)}))}, plane);
    const int down = step.face({step.bound(step.loop({step.oriented(rim, false)}))}, plane, false);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({up, down}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Edge edge = imported(step).model.edges.at(0);
    CHECK(std::get<BSplineCurve>(edge.curve).closed);
    CHECK(edge.t_end - edge.t_start == 1);
}

TEST_CASE("3: B-splines whose numbers disagree are errors that say how") {
    const auto error_of = [](const std::string& degree, const std::string& knots) {
        StepText step;
        const int curve =
            step.add("B_SPLINE_CURVE_WITH_KNOTS(''," + degree + "," + points(step, arch) +
                     ",.UNSPECIFIED.,.F.,.U.," + knots + ",.UNSPECIFIED.)");
        const int a = step.vertex(arch.front()), b = step.vertex(arch.back());
        const int edge = step.edge(a, b, curve);
        const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
        const int plane = step.add("PLANE(''," + StepText::ref(at) + ")");
        const int face = step.face({step.bound(step.loop({step.oriented(edge, true)}))}, plane);
        const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
        step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                            step.millimetres());
        return refused(step);
    };
    CHECK(mentions(error_of("4", "(5,5),(0.,1.)"), "degree"));
    CHECK(mentions(error_of("0", "(5,5),(0.,1.)"), "degree"));
    CHECK(mentions(error_of("-9223372036854775808", "(5,5),(0.,1.)"), "degree"));
    CHECK(mentions(error_of("3", "(4,3),(0.,1.)"), "add up to"));
    CHECK(mentions(error_of("3", "(4,4),(0.,1.,2.)"), "as many multiplicities"));
    CHECK(mentions(error_of("3", "(4,4),(1.,0.)"), "ascending"));
    CHECK(mentions(error_of("3", "(4,4),(0.,0.)"), "no domain"));
    CHECK(mentions(error_of("3", "(-4,12),(0.,1.)"), "multiplicities"));
    CHECK(mentions(error_of("3", "(4,1000000000000),(0.,1.)"), "multiplicities"));
}

namespace {

// Segments of a composite curve: each a curve and whether it is met along it.
std::string segments(StepText& step, const std::vector<std::pair<int, bool>>& pieces) {
    std::vector<int> ids;
    for (const auto& [curve, same_sense] : pieces) {
        ids.push_back(step.add("COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.," +
                               StepText::flag(same_sense) + "," + StepText::ref(curve) + ")"));
    }
    return StepText::refs(ids);
}

int trim(StepText& step, int basis, const std::string& from, const std::string& to, bool agrees,
         const std::string& master) {
    return step.add("TRIMMED_CURVE(''," + StepText::ref(basis) + "," + from + "," + to + "," +
                    StepText::flag(agrees) + "," + master + ")");
}

}  // namespace

TEST_CASE("1: a composite curve is its segments, one after the other") {
    // A quarter of a circle, trimmed by parameters, against its sense; a line trimmed by points; a polyline.
    const auto composite = [](double gap) {
        return [gap](StepText& step) {
            const int arc = trim(step, circle(step), "(PARAMETER_VALUE(0.))",
                                 "(PARAMETER_VALUE(1.5707963267948966))", true, ".PARAMETER.");
            const std::string a = "(" + StepText::ref(step.point({2, 0, 0})) + ")";
            const std::string b = "(" + StepText::ref(step.point({2, -3, 0})) + ")";
            const int line =
                trim(step, step.line({2, 7, 0}, {2, 8, 0}), a, b, false, ".CARTESIAN.");
            const int polyline = step.add(
                "POLYLINE(''," + points(step, {{2 + gap, -3, 0}, {5, -3, 0}, {5, 0, 0}}) + ")");
            return step.add("COMPOSITE_CURVE(''," +
                            segments(step, {{arc, false}, {line, true}, {polyline, true}}) +
                            ",.F.)");
        };
    };
    const Edge edge = edge_on(composite(0), {0, 2, 0}, {5, 0, 0}, true);
    const auto& spline = std::get<BSplineCurve>(edge.curve);
    CHECK(spline.degree == 2);
    const double r = std::sqrt(2.0);
    for (const Point3& p : {Point3(r, r, 0), Point3(2, -1, 0), Point3(4, -3, 0), Point3(5, -1, 0)})
        CHECK(near(evaluate(edge.curve, invert(edge.curve, p)), p));
    CHECK(!near(evaluate(edge.curve, invert(edge.curve, {-r, -r, 0})), {-r, -r, 0}));

    StepText gap;
    const int a = gap.vertex({0, 2, 0}), b = gap.vertex({5, 0, 0});
    const int along = gap.edge(a, b, composite(0.01)(gap));
    const int at = gap.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int face = gap.face({gap.bound(gap.loop({gap.oriented(along, true)}))},
                              gap.add("PLANE(''," + StepText::ref(at) + ")"));
    const int shell = gap.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    gap.representation({gap.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                       gap.millimetres());
    CHECK(mentions(refused(gap), "does not begin where the segment before it ends"));
}

TEST_CASE("1: trims in degrees, and a line's in lengths of its vector") {
    StepText step;
    const int degrees = step.context({step.si_length(".MILLI."), step.degree()});
    const int arc = trim(step, circle(step), "(PARAMETER_VALUE(0.))", "(PARAMETER_VALUE(90.))",
                         true, ".PARAMETER.");
    const int direction = step.direction(Vector3::UnitY());
    const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",5.)");
    const int ray = step.add("LINE(''," + StepText::ref(step.point({2, 0, 0})) + "," +
                             StepText::ref(vector) + ")");
    const int line =
        trim(step, ray, "(PARAMETER_VALUE(-2.))", "(PARAMETER_VALUE(0.))", true, ".PARAMETER.");
    const int both =
        step.add("COMPOSITE_CURVE(''," + segments(step, {{line, true}, {arc, true}}) + ",.F.)");
    const int edge = step.edge(step.vertex({2, -10, 0}), step.vertex({0, 2, 0}), both);
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int face = step.face({step.bound(step.loop({step.oriented(edge, true)}))},
                               step.add("PLANE(''," + StepText::ref(at) + ")"));
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        degrees);
    const Imported result = imported(step);
    CHECK(result.diagnostics.empty());
    const Edge& found = result.model.edges.at(0);
    CHECK(near(evaluate(found.curve, found.t_start), {2, -10, 0}));
    CHECK(near(evaluate(found.curve, found.t_end), {0, 2, 0}));
}

TEST_CASE("1: offset and moved curves") {
    const auto offset = [](const std::function<int(StepText&)>& basis, double distance,
                           const Vector3& reference) {
        return [=](StepText& step) {
            const int curve = basis(step), direction = step.direction(reference);
            return step.add("OFFSET_CURVE_3D(''," + StepText::ref(curve) + "," +
                            StepText::num(distance) + ",.F.," + StepText::ref(direction) + ")");
        };
    };
    const auto line = [](StepText& step) { return step.line({0, 0, 0}, {4, 0, 0}); };
    // z x x is y.
    const Edge moved = edge_on(offset(line, 3, Vector3::UnitZ()), {0, 3, 0}, {4, 3, 0}, true);
    CHECK(std::holds_alternative<Line>(moved.curve));
    const Edge inner =
        edge_on(offset(circle, 0.5, Vector3::UnitZ()), {1.5, 0, 0}, {0, 1.5, 0}, true);
    CHECK(std::get<Circle>(inner.curve).radius_mm == 1.5);
    const Edge outer =
        edge_on(offset(circle, 0.5, -Vector3::UnitZ()), {2.5, 0, 0}, {0, 2.5, 0}, true);
    CHECK(std::get<Circle>(outer.curve).radius_mm == 2.5);
    // Beyond the centre a circle begins on the other side.
    const Edge beyond = edge_on(offset(circle, 5, Vector3::UnitZ()), {-3, 0, 0}, {0, -3, 0}, true);
    CHECK(std::get<Circle>(beyond.curve).radius_mm == 3);
    CHECK(near(evaluate(beyond.curve, 0.5 * (beyond.t_start + beyond.t_end)),
               {-3 * std::sqrt(0.5), -3 * std::sqrt(0.5), 0}));
    const Edge replica = edge_on(
        [](StepText& step) {
            const int parent = circle(step), at = step.point({7, 0, 0});
            const int to = step.add("CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,$," +
                                    StepText::ref(at) + ",2.,$)");
            return step.add("CURVE_REPLICA(''," + StepText::ref(parent) + "," + StepText::ref(to) +
                            ")");
        },
        {11, 0, 0}, {7, 4, 0}, true);
    CHECK(std::get<Circle>(replica.curve).radius_mm == doctest::Approx(4));
}

namespace {

struct Basis {
    std::string name;
    std::function<int(StepText&)> write;
    std::function<Point3(double)> at;
    double from, to;
};

std::vector<Basis> bases_of_offsets() {
    const auto conic = [](const std::string& type, const std::string& sizes) {
        return [=](StepText& step) {
            const int at = step.placement({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX());
            return step.add(type + "(''," + StepText::ref(at) + sizes + ")");
        };
    };
    const std::vector<Point3> points{{0, 0, 0}, {3, 1, 1}, {5, 4, 0}, {9, 5, 2}};
    const auto spline = [=](StepText& step) {
        std::vector<int> ids;
        for (const Point3& p : points) ids.push_back(step.point(p));
        return step.add("BEZIER_CURVE('',3," + StepText::refs(ids) + ",.UNSPECIFIED.,.F.,.U.)");
    };
    const auto spline_at = [=](double t) -> Point3 {
        const double r = 1 - t;
        return r * r * r * points[0] + 3 * r * r * t * points[1] + 3 * r * t * t * points[2] +
               t * t * t * points[3];
    };
    const auto on_circle = [](double t) {
        return Point3(1 + 2 * std::cos(t), 2 + 2 * std::sin(t), 3);
    };
    const auto on_ellipse = [](double t) {
        return Point3(1 + 5 * std::cos(t), 2 + 3 * std::sin(t), 3);
    };
    const auto on_parabola = [](double t) { return Point3(1 + 2 * t * t, 2 + 4 * t, 3); };
    const auto on_hyperbola = [](double t) {
        return Point3(1 + 4 * std::cosh(t), 2 + 3 * std::sinh(t), 3);
    };
    return {{"circle", conic("CIRCLE", ",2."), on_circle, 0.5, 5},
            {"ellipse", conic("ELLIPSE", ",5.,3."), on_ellipse, 0.5, 5},
            {"parabola", conic("PARABOLA", ",2."), on_parabola, -1, 1.5},
            {"hyperbola", conic("HYPERBOLA", ",4.,3."), on_hyperbola, -1, 1},
            {"spline", spline, spline_at, 0.05, 0.95}};
}

}  // namespace

TEST_CASE("offset 2: every curve goes along the reference direction x its tangent") {
    const Vector3 leaning = Vector3(0.3, -0.2, 1).normalized();
    for (const Basis& basis : bases_of_offsets()) {
        CAPTURE(basis.name);
        for (const Vector3& reference : {Vector3(Vector3::UnitZ()), Vector3(-leaning), leaning}) {
            for (const double distance : {-0.7, 0.4}) {
                const auto exact = [&](double t) -> Point3 {
                    // By fourth-order differences: exact to 1e-10.
                    constexpr double h = 1e-3;
                    const Vector3 tangent = 8 * (basis.at(t + h) - basis.at(t - h)) -
                                            (basis.at(t + 2 * h) - basis.at(t - 2 * h));
                    return basis.at(t) + distance * reference.cross(tangent).normalized();
                };
                const auto write = [&](StepText& step) {
                    const int curve = basis.write(step), direction = step.direction(reference);
                    return step.add("OFFSET_CURVE_3D(''," + StepText::ref(curve) + "," +
                                    StepText::num(distance) + ",.F.," + StepText::ref(direction) +
                                    ")");
                };
                for (const bool along : {true, false}) {
                    const double a = along ? basis.from : basis.to;
                    const double b = along ? basis.to : basis.from;
                    const Edge edge = edge_on(write, exact(a), exact(b), along);
                    CHECK(near(evaluate(edge.curve, edge.t_start), exact(a)));
                    CHECK(near(evaluate(edge.curve, edge.t_end), exact(b)));
                    for (int i = 0; i <= 100; ++i) {
                        const Point3 p = exact(a + (b - a) * i / 100);
                        const double t = invert(edge.curve, p);
                        CHECK((evaluate(edge.curve, t) - p).norm() <= resolution_mm / 2);
                    }
                }
            }
        }
    }
}
