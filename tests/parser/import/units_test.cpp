// Units, by the numbers of the contract in parser/import/units.h.

#include <doctest/doctest.h>

#include <functional>
#include <numbers>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;
using std::numbers::pi;

namespace {

Model box_in(const std::function<int(StepText&)>& context) {
    StepText step;
    const int solid = step.box({0, 0, 0}, {1, 2, 3});
    step.representation({solid}, context(step));
    return imported(step).model;
}

double height(const Model& model) {
    return box_of(model).max().z();
}

// The half angle of a cone face, stated as `angle` in the unit that `unit` makes.
Surface cone(const std::string& radius, const std::string& angle,
             const std::function<int(StepText&)>& unit, double vertex_height = 5) {
    StepText step;
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int surface =
        step.add("CONICAL_SURFACE(''," + StepText::ref(at) + "," + radius + "," + angle + ")");
    const int loop = step.add("VERTEX_LOOP(''," + StepText::ref(step.vertex({0, 0, 0})) + ")");
    const int vertex = step.vertex({1, 0, vertex_height});
    const int ring_at = step.placement({0, 0, vertex_height}, Vector3::UnitZ(), Vector3::UnitX());
    const int ring =
        step.edge(vertex, vertex, step.add("CIRCLE(''," + StepText::ref(ring_at) + ",1.)"));
    const int face =
        step.face({step.bound(loop), step.bound(step.loop({step.oriented(ring, true)}))}, surface);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.context({step.si_length(".MILLI."), unit(step)}));
    return imported(step).model.faces.at(0).surface;
}

int in_radians(StepText& step) {
    return step.radian();
}
int in_degrees(StepText& step) {
    return step.degree();
}

}  // namespace

TEST_CASE("1: lengths in SI units and in units converted from them") {
    const auto si = [](const char* prefix) {
        return [prefix](StepText& step) {
            return step.context({step.si_length(prefix), step.radian()});
        };
    };
    CHECK(height(box_in(si(".MILLI."))) == 3);
    CHECK(height(box_in(si(".CENTI."))) == 30);
    CHECK(height(box_in(si("$"))) == 3000);
    CHECK(height(box_in(si(".MICRO."))) == doctest::Approx(0.003).epsilon(1e-15));
    CHECK(height(box_in(si(".HECTO."))) == 3e5);
    CHECK(height(box_in([](StepText& step) {
              return step.context({step.converted_length("INCH", 25.4, step.si_length(".MILLI."))});
          })) == doctest::Approx(76.2).epsilon(1e-15));
    CHECK(height(box_in([](StepText& step) {
              return step.context({step.converted_length("INCH", 0.0254, step.si_length("$"))});
          })) == doctest::Approx(76.2).epsilon(1e-15));
    // A foot of inches: conversions of conversions.
    CHECK(height(box_in([](StepText& step) {
              const int inch = step.converted_length("INCH", 2.54, step.si_length(".CENTI."));
              return step.context({step.converted_length("FOOT", 12, inch)});
          })) == doctest::Approx(914.4).epsilon(1e-14));
}

TEST_CASE("1: the uncertainty is converted as well") {
    const Model model = box_in([](StepText& step) {
        const int metre = step.si_length("$");
        const int measure = step.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-05)," +
                                     StepText::ref(metre) + ",'distance_accuracy_value','')");
        return step.context({metre}, {measure});
    });
    CHECK(model.uncertainty_mm == doctest::Approx(0.01));
}

TEST_CASE("1, 2: angles in radians and degrees") {
    CHECK(std::get<Cone>(cone("1.", "0.5", in_radians)).half_angle_rad == 0.5);
    CHECK(std::get<Cone>(cone("1.", "45.", in_degrees)).half_angle_rad ==
          doctest::Approx(pi / 4).epsilon(1e-15));
    CHECK(std::get<Cone>(cone("1.", "45.", [](StepText& s) {
              return s.degree("0.01745");
          })).half_angle_rad != doctest::Approx(pi / 4).epsilon(1e-15));
}

TEST_CASE("1: cones with negative angles or radii are the same cones from their other end") {
    // radius = 2 + h tan(-a) narrows upwards.
    const Cone narrowing = std::get<Cone>(cone("2.", "-0.25", in_radians, 1));
    CHECK(narrowing.half_angle_rad == 0.25);
    CHECK(near(narrowing.frame.z, -Vector3::UnitZ()));
    CHECK(near(evaluate(Surface(narrowing), {0, 0}), {2, 0, 0}));
    // radius = -2 + h: the apex is at h = 2.
    const Cone shifted = std::get<Cone>(cone("-2.", "45.", in_degrees));
    CHECK(shifted.radius_mm == 0);
    CHECK(near(shifted.frame.origin, {0, 0, 2}));
    // The face lies below the apex: the other nappe is meant.
    const Cone below = std::get<Cone>(cone("0.", "45.", in_degrees, -5));
    CHECK(near(below.frame.z, -Vector3::UnitZ()));
    CHECK(near(evaluate(Surface(below), {0, 3}), {3, 0, -3}));
    // No angle at all: a cylinder.
    CHECK(std::get<Cylinder>(cone("2.", "0.", in_radians)).radius_mm == 2);
}

TEST_CASE("1: units of other quantities do not matter") {
    const Model model = box_in([](StepText& step) {
        const int gram = step.add("(MASS_UNIT()NAMED_UNIT(*)SI_UNIT($,.GRAM.))");
        const int measure =
            step.add("MASS_MEASURE_WITH_UNIT(MASS_MEASURE(453.6)," + StepText::ref(gram) + ")");
        const int pound = step.add("(CONVERSION_BASED_UNIT('POUND'," + StepText::ref(measure) +
                                   ")MASS_UNIT()NAMED_UNIT(*))");
        const int odd = step.add("(CONTEXT_DEPENDENT_UNIT('each')NAMED_UNIT(*))");
        return step.context({pound, step.si_length(".CENTI."), odd});
    });
    CHECK(height(model) == 30);
}

TEST_CASE("3: no unit of length: millimetres, and a warning") {
    StepText step;
    step.representation({step.box({0, 0, 0}, {1, 2, 3})}, step.context({}));
    const Imported result = imported(step);
    CHECK(height(result.model) == 3);
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "millimetres"));
    CHECK(result.diagnostics[0].severity == Severity::warning);
}

TEST_CASE("1: units that cannot be are errors") {
    const auto error_in = [](const std::function<int(StepText&)>& context) {
        StepText step;
        step.representation({step.box({0, 0, 0}, {1, 2, 3})}, context(step));
        return refused(step);
    };
    CHECK(mentions(error_in([](StepText& s) {
                       return s.context({s.converted_length("X", 0, s.si_length("$"))});
                   }),
                   "must be positive"));
    CHECK(mentions(error_in([](StepText& s) { return s.context({s.si_length(".BIG.")}); }),
                   "SI prefix"));
    CHECK(mentions(error_in([](StepText& s) {
                       return s.context(
                           {s.add("(CONTEXT_DEPENDENT_UNIT('brick')LENGTH_UNIT()NAMED_UNIT(*))")});
                   }),
                   "not supported"));
    CHECK(mentions(error_in([](StepText& s) {
                       const int unit = s.reserve();
                       const int measure = s.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.)," +
                                                 StepText::ref(unit) + ")");
                       s.define(unit, "(CONVERSION_BASED_UNIT('X'," + StepText::ref(measure) +
                                          ")LENGTH_UNIT()NAMED_UNIT(*))");
                       return s.context({unit});
                   }),
                   "itself"));
}
