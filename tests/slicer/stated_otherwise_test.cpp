// One solid stated in two ways is cut alike: a cylinder by its elementary surface, and by offsets and curves in
// parameters that amount to it.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernel/brep/placement.h"
#include "kernel/section_figures.h"
#include "parser/import/checks.h"

using namespace lyr;
using namespace lyr::test;
using std::numbers::pi;

namespace {

constexpr double radius_mm = 5, height_mm = 20;

int flat(StepText& step, const std::string& type, double x, double y) {
    return step.add(type + "('',(" + StepText::num(x) + "," + StepText::num(y) + "))");
}

// An edge's curve as nothing but a line in the parameters of a surface.
int pcurve(StepText& step, int surface, const Point2& at, const Vector2& along) {
    const int origin = flat(step, "CARTESIAN_POINT", at.x(), at.y());
    const int direction = flat(step, "DIRECTION", along.x(), along.y());
    const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",1.)");
    const int line =
        step.add("LINE(''," + StepText::ref(origin) + "," + StepText::ref(vector) + ")");
    const int context =
        step.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)REPRESENTATION_CONTEXT('',''))");
    const int representation = step.add("DEFINITIONAL_REPRESENTATION(''," + StepText::refs({line}) +
                                        "," + StepText::ref(context) + ")");
    return step.add("PCURVE(''," + StepText::ref(surface) + "," + StepText::ref(representation) +
                    ")");
}

// A cylinder as a rational B-spline over u in quarters of a turn, v in millimetres.
int spline_cylinder(StepText& step, double radius) {
    constexpr int x[]{1, 1, 0, -1, -1, -1, 0, 1, 1}, y[]{0, 1, 1, 1, 0, -1, -1, -1, 0};
    std::string net, weights;
    for (std::size_t i = 0; i < 9; ++i) {
        const std::string comma = i > 0 ? "," : "";
        const int low = step.point({radius * x[i], radius * y[i], 0});
        const int high = step.point({radius * x[i], radius * y[i], height_mm});
        const std::string weight = StepText::num(i % 2 == 0 ? 1 : std::sqrt(0.5));
        net += comma + StepText::refs({low, high});
        weights += comma + "(" + weight + "," + weight + ")";
    }
    return step.add("(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,1,(" + net +
                    "),.UNSPECIFIED.,.T.,.F.,.U.)B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3),(2,2),(0.,"
                    "1.,2.,3.,4.),(0.,20.),.UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()"
                    "RATIONAL_B_SPLINE_SURFACE((" +
                    weights + "))REPRESENTATION_ITEM('')SURFACE())");
}

int offset_of(StepText& step, int basis, double distance) {
    return step.add("OFFSET_SURFACE(''," + StepText::ref(basis) + "," + StepText::num(distance) +
                    ",.F.)");
}

int elementary(StepText& step, double radius) {
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    return step.add("CYLINDRICAL_SURFACE(''," + StepText::ref(at) + "," + StepText::num(radius) +
                    ")");
}

// `turn`: the parameter of a full turn around the side; `lean`: how far the seam leads around on its way up.
Model cylinder(int (*side)(StepText&), double turn, double lean) {
    StepText step;
    const int surface = side(step);
    const double angle = 2 * pi * lean / turn;
    const int below = step.vertex({radius_mm, 0, 0});
    const int above =
        step.vertex({radius_mm * std::cos(angle), radius_mm * std::sin(angle), height_mm});
    const int bottom = step.edge(below, below, pcurve(step, surface, {0, 0}, {1, 0}));
    const int top = step.edge(above, above, pcurve(step, surface, {lean, height_mm}, {1, 0}));
    const int seam = step.edge(
        below, above, pcurve(step, surface, {0, 0}, Vector2(lean, height_mm).normalized()));
    const auto plane = [&](double z) {
        const int at = step.placement({0, 0, z}, Vector3::UnitZ(), Vector3::UnitX());
        return step.add("PLANE(''," + StepText::ref(at) + ")");
    };
    const auto around = [&](const std::vector<int>& uses) {
        return std::vector<int>{step.bound(step.loop(uses))};
    };
    const int shell = step.add(
        "CLOSED_SHELL(''," +
        StepText::refs({step.face(around({step.oriented(bottom, true), step.oriented(seam, true),
                                          step.oriented(top, false), step.oriented(seam, false)}),
                                  surface),
                        step.face(around({step.oriented(bottom, false)}), plane(0), false),
                        step.face(around({step.oriented(top, true)}), plane(height_mm))}) +
        ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Imported result = imported(step);
    CHECK(result.diagnostics.empty());
    return result.model;
}

Model plain() {
    StepText step;
    step.representation({step.cylinder(radius_mm, height_mm)}, step.millimetres());
    return imported(step).model;
}

}  // namespace

TEST_CASE("a cylinder stated as an offset, its seam a helix, is cut like a cylinder") {
    struct Way {
        const char* name;
        Model model;
    };
    const auto grown = [](StepText& s) { return offset_of(s, spline_cylinder(s, 3), 2); };
    const auto shrunk = [](StepText& s) { return offset_of(s, spline_cylinder(s, 9), -4); };
    const std::vector<Way> ways{
        {"elementary, helical seam",
         cylinder([](StepText& s) { return elementary(s, radius_mm); }, 2 * pi, 9)},
        {"elementary offset, helical seam",
         cylinder([](StepText& s) { return offset_of(s, elementary(s, 6), -1); }, 2 * pi, -2)},
        {"free-form, sloped seam",
         cylinder([](StepText& s) { return spline_cylinder(s, radius_mm); }, 4, 1.5)},
        {"free-form offset outwards", cylinder(grown, 4, 0)},
        {"free-form offset inwards", cylinder(shrunk, 4, 0)},
        {"free-form offset, sloped seam", cylinder(grown, 4, 1.5)}};
    const Tolerance tolerance{0.001};
    for (const double tilt : {0.0, 0.6, pi / 2}) {
        CAPTURE(tilt);
        const Eigen::Affine3d position(
            Eigen::AngleAxisd(tilt, Vector3(1, 0.3, 0).normalized()).toRotationMatrix());
        const Model reference = transformed(plain(), position);
        const Cutter exact(reference, tolerance);
        const HeightRange range = exact.height_range();
        for (const Way& way : ways) {
            CAPTURE(way.name);
            const Model model = transformed(way.model, position);
            const Cutter cutter(model, tolerance);
            CHECK(std::abs(cutter.height_range().top_mm - range.top_mm) < 2 * resolution_mm);
            constexpr int planes = 37;
            for (int i = 0; i < planes; ++i) {
                CAPTURE(i);
                const double z =
                    range.bottom_mm + (i + 0.5) / planes * (range.top_mm - range.bottom_mm);
                const Section section = cutter.cut(z), other = exact.cut(z);
                CHECK(section.open == 0);
                CHECK(section.diagnostics.empty());
                CHECK(std::abs(testing::area_of(section) - testing::area_of(other)) <=
                      tolerance.total_mm * testing::length_of(other));
            }
        }
    }
}
