// The contract in parser/import/curve_on_surface.h, by its numbers, through files: curves in the parameters of every
// surface lie where the formulas of ISO 10303-42 put them.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "stated_surfaces.h"

using namespace lyr;
using namespace lyr::test;

TEST_CASE("2: a sloped line, helix or not, lies on every surface, whichever way it runs") {
    for (const Stated& on : surfaces()) {
        CAPTURE(on.name);
        for (const bool down : {false, true}) {
            const Point2 a(on.from.x(), down ? on.to.y() : on.from.y());
            const Point2 b(on.to.x(), down ? on.from.y() : on.to.y());
            const Vector2 step = (b - a).normalized();
            const double length = (b - a).norm(), before = 0.3 * length;
            // It begins elsewhere than the edge does.
            const Point2 at = a - before * step;
            const Edge edge = edge_on(on.write, flat_line(at.x(), at.y(), step.x(), step.y()),
                                      on.at(a), on.at(b));
            CHECK(edge.t_start == doctest::Approx(before).epsilon(1e-6));
            CHECK(edge.t_end == doctest::Approx(before + length).epsilon(1e-6));
            const Edge back = edge_on(on.write, flat_line(at.x(), at.y(), -step.x(), -step.y()),
                                      on.at(b), on.at(a));
            for (int i = 0; i <= 500; ++i) {
                const double t = before + length * i / 500;
                const Point3 exact = on.at(at + t * step);
                CHECK((evaluate(edge.curve, t) - exact).norm() <= resolution_mm / 2);
                CHECK((evaluate(back.curve, -t) - exact).norm() <= resolution_mm / 2);
            }
        }
    }
}

TEST_CASE("the face's surface is the one that its curves lie on") {
    for (const Stated& on : surfaces()) {
        CAPTURE(on.name);
        const Vector2 step = (on.to - on.from).normalized();
        const Model model =
            imported(face_step(on.write, flat_line(on.from.x(), on.from.y(), step.x(), step.y()),
                               on.at(on.from), on.at(on.to), false))
                .model;
        const Surface& surface = model.faces.at(0).surface;
        for (int i = 0; i <= 40; ++i) {
            const Point3 p = on.at(on.from + i / 40.0 * (on.to - on.from));
            CHECK((evaluate(surface, invert(surface, p)) - p).norm() <= resolution_mm / 2);
        }
    }
}

TEST_CASE("1: lines along one parameter of every surface") {
    for (const Stated& on : surfaces()) {
        CAPTURE(on.name);
        for (const bool along_u : {false, true}) {
            const Point2 a = on.from;
            const Point2 b = along_u ? Point2(std::min(on.to.x(), a.x() + 5), a.y())
                                     : Point2(a.x(), std::min(on.to.y(), a.y() + 5));
            const Vector2 step = (b - a).normalized();
            for (const bool reversed : {false, true}) {
                const Vector2 sense = reversed ? Vector2(-step) : step;
                const Edge edge =
                    edge_on(on.write, flat_line(a.x(), a.y(), sense.x(), sense.y()),
                            reversed ? on.at(b) : on.at(a), reversed ? on.at(a) : on.at(b));
                for (int i = 1; i < 50; ++i) {
                    const Point3 exact = on.at(a + i / 50.0 * (b - a));
                    const double t = invert(edge.curve, exact);
                    CHECK((evaluate(edge.curve, t) - exact).norm() <= resolution_mm / 2);
                }
                // Between the ends, not the other way around.
                double least = std::numeric_limits<double>::infinity();
                for (int i = 0; i <= 2000; ++i)
                    least =
                        std::min(least, (middle(edge) - on.at(a + i / 2000.0 * (b - a))).norm());
                CHECK(least < 0.02);
            }
        }
    }
}

TEST_CASE("2: conics with and without ends on every surface") {
    for (const Stated& on : surfaces()) {
        CAPTURE(on.name);
        const Point2 centre = 0.5 * (on.from + on.to);
        const double radius = 0.4 * (on.to - on.from).cwiseAbs().minCoeff();
        const Write circle = [=](StepText& step) {
            const int at =
                step.add("AXIS2_PLACEMENT_2D(''," +
                         StepText::ref(flat_point(step, centre.x(), centre.y())) + ",$)");
            return step.add("CIRCLE(''," + StepText::ref(at) + "," + StepText::num(radius) + ")");
        };
        const auto on_circle = [=](double t) -> Point2 {
            return centre + radius * Vector2(std::cos(t), std::sin(t));
        };
        const Edge arc = edge_on(on.write, circle, on.at(on_circle(0.3)), on.at(on_circle(4)));
        const Write parabola = [=](StepText& step) {
            const int at =
                step.add("AXIS2_PLACEMENT_2D(''," +
                         StepText::ref(flat_point(step, centre.x(), centre.y())) + ",$)");
            return step.add("PARABOLA(''," + StepText::ref(at) + "," + StepText::num(radius / 4) +
                            ")");
        };
        const auto on_parabola = [=](double t) -> Point2 {
            return centre + radius / 4 * Vector2(t * t, 2 * t);
        };
        const Edge open =
            edge_on(on.write, parabola, on.at(on_parabola(-1.2)), on.at(on_parabola(1.5)));
        for (int i = 0; i <= 100; ++i) {
            const Point3 p = on.at(on_circle(0.3 + 3.7 * i / 100));
            CHECK((evaluate(arc.curve, invert(arc.curve, p)) - p).norm() <= resolution_mm / 2);
            const Point3 q = on.at(on_parabola(-1.2 + 2.7 * i / 100));
            CHECK((evaluate(open.curve, invert(open.curve, q)) - q).norm() <= resolution_mm / 2);
        }
    }
}

TEST_CASE("3: a winding of a torus that comes back to its start goes around once") {
    // Three times around the tube for twice around the axis.
    const Write torus = surface("TOROIDAL_SURFACE", ",5.,2.");
    const auto at = [](double t) -> Point3 {
        return origin + turned({5 + 2 * std::cos(3 * t), 0, 2 * std::sin(3 * t)}, 2 * t);
    };
    StepText step;
    const int basis = torus(step);
    const int context =
        step.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)REPRESENTATION_CONTEXT('',''))");
    const int representation =
        step.add("DEFINITIONAL_REPRESENTATION(''," + StepText::refs({flat_line(0, 0, 2, 3)(step)}) +
                 "," + StepText::ref(context) + ")");
    const int pcurve =
        step.add("PCURVE(''," + StepText::ref(basis) + "," + StepText::ref(representation) + ")");
    const int vertex = step.vertex(at(0));
    const int edge = step.edge(vertex, vertex, pcurve);
    const int face = step.face({step.bound(step.loop({step.oriented(edge, true)}))}, basis);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Edge winding = imported(step).model.edges.at(0);
    CHECK(std::get<BSplineCurve>(winding.curve).closed);
    const double turn = 2 * std::numbers::pi * std::sqrt(13);
    CHECK(winding.t_end - winding.t_start == doctest::Approx(turn));
    for (int i = 0; i < 300; ++i) {
        const double share = i / 300.0;
        CHECK((evaluate(winding.curve, winding.t_start + share * turn) -
               at(2 * std::numbers::pi * share))
                  .norm() <= resolution_mm / 2);
    }
}
