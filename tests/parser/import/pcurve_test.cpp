// Edges of which only a curve in the parameters of a surface is known: the contract in parser/import/pcurve.h.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>

#include "kernel/geometry/bspline_surface.h"
#include "stated_surfaces.h"

using namespace lyr;
using namespace lyr::test;

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
    CHECK(std::holds_alternative<BSplineCurve>(edge.curve));
    CHECK(edge.t_start == 0);
    CHECK(edge.t_end == 2);
    for (int i = 0; i <= 1000; ++i) {
        const double t = i / 500.0;
        CHECK((evaluate(edge.curve, t) - lifted(flat(t))).norm() <= resolution_mm / 4);
    }
}

TEST_CASE("2: an offset in parameters goes to the left; every way to write a pcurve is one") {
    const Write cylinder = surface("CYLINDRICAL_SURFACE", ",2.");
    // A circle of radius 1, in radians and millimetres, by 0.25 to its inside.
    const Write ring = [](StepText& step) {
        const int at =
            step.add("AXIS2_PLACEMENT_2D(''," + StepText::ref(flat_point(step, 2, 5)) + ",$)");
        const int circle = step.add("CIRCLE(''," + StepText::ref(at) + ",1.)");
        return step.add("OFFSET_CURVE_2D(''," + StepText::ref(circle) + ",0.25,.F.)");
    };
    const auto at = [](double t) -> Point3 {
        return origin + turned({2, 0, 5 + 0.75 * std::sin(t)}, 2 + 0.75 * std::cos(t));
    };
    const auto check = [&](const Edge& edge) {
        for (double t = 0.5; t <= 3; t += 0.1)
            CHECK(near(evaluate(edge.curve, invert(edge.curve, at(t))), at(t)));
    };
    StepText step = face_step(cylinder, ring, at(0.5), at(3), false);
    check(imported(step).model.edges.at(0));
    const std::string text = step.text();
    const std::size_t begin = text.find("PCURVE('',") + 10, end = text.find(')', begin);
    const std::string references = text.substr(begin, end - begin);
    for (const std::string& form :
         {"BOUNDED_PCURVE(''," + references + ")",
          "(BOUNDED_CURVE()BOUNDED_PCURVE()CURVE()GEOMETRIC_REPRESENTATION_ITEM()PCURVE(" +
              references + ")REPRESENTATION_ITEM(''))"}) {
        std::string other = text;
        other.replace(begin - 10, end + 1 - (begin - 10), form);
        const auto file = part21::File::parse("test.step", other);
        REQUIRE(file.ok());
        Diagnostics diagnostics;
        const Result<Model> model = importer::import_model(*file, diagnostics);
        REQUIRE_MESSAGE(model.ok(), (model.ok() ? "" : to_string(model.error())));
        check(model->edges.at(0));
    }
}

TEST_CASE("2: what has no ends, and needs some, is named") {
    // Swept, the helix would have to be known without an edge.
    const Write swept = [](StepText& step) {
        const int context =
            step.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)REPRESENTATION_CONTEXT('',''))");
        const int representation = step.add("DEFINITIONAL_REPRESENTATION(''," +
                                            StepText::refs({flat_line(0, 0, 1, 1)(step)}) + "," +
                                            StepText::ref(context) + ")");
        const int helix =
            step.add("PCURVE(''," + StepText::ref(surface("CYLINDRICAL_SURFACE", ",2.")(step)) +
                     "," + StepText::ref(representation) + ")");
        const int vector =
            step.add("VECTOR(''," + StepText::ref(step.direction({1, 0, 0})) + ",1.)");
        return step.add("SURFACE_OF_LINEAR_EXTRUSION(''," + StepText::ref(helix) + "," +
                        StepText::ref(vector) + ")");
    };
    const Diagnostic helix =
        refused(face_step(swept, flat_line(0, 0, 1, 0), {3, 2, 3}, {1, 4, 9}, false));
    CHECK(helix.status == ExitStatus::unsupported);
    CHECK(mentions(helix, "PCURVE #"));
}
