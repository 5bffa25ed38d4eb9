// Solids of polygons and triangles: contract 3 of parser/import/shells.h and that of parser/import/triangles.h.

#include <doctest/doctest.h>

#include <array>
#include <functional>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;

namespace {

// Corners of a box as bits: x, y, z; its sides counter-clockwise as seen from outside.
constexpr std::size_t box_sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

Point3 corner(const Point3& low, const Point3& high, std::size_t i) {
    return {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()};
}

struct PolygonFlags {
    bool shares_points = true;  // else each polygon states points of its own
    bool with_planes = false;   // FACE_SURFACE, else FACE
    bool reversed = false;      // loops clockwise, orientation of bounds .F.
};

int polygon_shell(StepText& step, const Point3& low, const Point3& high,
                  const PolygonFlags& flags = {}) {
    std::array<int, 8> shared;
    for (std::size_t i = 0; i < 8; ++i) shared[i] = step.point(corner(low, high, i));
    std::vector<int> faces;
    for (const auto& side : box_sides) {
        std::vector<int> points;
        for (const std::size_t i : side) {
            points.push_back(flags.shares_points ? shared[i] : step.point(corner(low, high, i)));
        }
        if (flags.reversed) std::reverse(points.begin(), points.end());
        const int loop = step.add("POLY_LOOP(''," + StepText::refs(points) + ")");
        const int bound = step.bound(loop, !flags.reversed);
        if (!flags.with_planes) {
            faces.push_back(step.add("FACE(''," + StepText::refs({bound}) + ")"));
            continue;
        }
        const Point3 a = corner(low, high, side[0]), b = corner(low, high, side[1]);
        const Vector3 z = (b - a).cross(corner(low, high, side[2]) - b);
        const int plane = step.add("PLANE(''," + StepText::ref(step.placement(a, z, b - a)) + ")");
        faces.push_back(step.add("FACE_SURFACE(''," + StepText::refs({bound}) + "," +
                                 StepText::ref(plane) + ",.T.)"));
    }
    return step.add("CLOSED_SHELL(''," + StepText::refs(faces) + ")");
}

// Twelve triangles on eight points, as text of COORDINATES_LIST and triangles.
std::string coordinates(const Point3& low, const Point3& high) {
    std::string text = "COORDINATES_LIST('',8,(";
    for (std::size_t i = 0; i < 8; ++i) {
        const Point3 p = corner(low, high, i);
        text.append(i > 0 ? ",(" : "(").append(StepText::num(p.x())).append(",");
        text.append(StepText::num(p.y())).append(",").append(StepText::num(p.z())).append(")");
    }
    return text + "))";
}

std::string triple(std::size_t a, std::size_t b, std::size_t c) {
    std::string text = "(";
    text.append(std::to_string(a + 1)).append(",").append(std::to_string(b + 1));
    return text.append(",").append(std::to_string(c + 1)).append(")");
}

// `count` of the sides of a box.
std::string box_triangles(std::size_t count, bool inside_out = false) {
    std::string text;
    for (std::size_t s = 0; s < count; ++s) {
        const auto& side = box_sides[s];
        const std::size_t b = side[inside_out ? 2 : 1], c = side[inside_out ? 1 : 2];
        const std::size_t d = side[inside_out ? 3 : 2], e = side[inside_out ? 2 : 3];
        if (!text.empty()) text += ',';
        text += triple(side[0], b, c) + "," + triple(side[0], d, e);
    }
    return "(" + text + ")";
}

int tessellated_box(StepText& step, std::size_t sides = 6, const std::string& link = "$",
                    bool inside_out = false) {
    const int points = step.add(coordinates({1, 2, 3}, {4, 6, 8}));
    const int face = step.add("TRIANGULATED_FACE(''," + StepText::ref(points) + ",8,(),$,()," +
                              box_triangles(sides, inside_out) + ")");
    return step.add("TESSELLATED_SOLID('mesh'," + StepText::refs({face}) + "," + link + ")");
}

}  // namespace

TEST_CASE("3: a faceted solid is planes and shared straight edges, in every form") {
    for (int form = 0; form < 8; ++form) {
        StepText step;
        const PolygonFlags flags{(form & 1) != 0, (form & 2) != 0, (form & 4) != 0};
        const int shell = polygon_shell(step, {1, 2, 3}, {4, 6, 8}, flags);
        step.representation({step.add("FACETED_BREP('facets'," + StepText::ref(shell) + ")")},
                            step.millimetres(), "FACETED_BREP_SHAPE_REPRESENTATION");
        const Imported result = imported(step);
        CHECK(result.diagnostics.empty());
        check_model(result.model);
        CHECK(near(box_of(result.model).min(), {1, 2, 3}));
        CHECK(plane_volume(result.model) == doctest::Approx(3 * 4 * 5));
        CHECK(result.model.vertices.size() == 8);
        CHECK(result.model.edges.size() == 12);
        CHECK(result.model.solids[0].name == "facets");
    }
}

TEST_CASE("3: a faceted solid with a void") {
    StepText step;
    const int outer = polygon_shell(step, {0, 0, 0}, {10, 10, 10});
    const int inner = polygon_shell(step, {1, 1, 1}, {4, 5, 6});
    const int oriented = step.add("ORIENTED_CLOSED_SHELL('',*," + StepText::ref(inner) + ",.F.)");
    const int solid = step.add("(BREP_WITH_VOIDS((" + StepText::ref(oriented) +
                               "))FACETED_BREP()GEOMETRIC_REPRESENTATION_ITEM()"
                               "MANIFOLD_SOLID_BREP(" +
                               StepText::ref(outer) + ")REPRESENTATION_ITEM('')SOLID_MODEL())");
    step.representation({solid}, step.millimetres());
    const Imported result = imported(step);
    CHECK(result.diagnostics.empty());
    check_model(result.model);
    CHECK(result.model.solids[0].shell_count == 2);
    CHECK(plane_volume(result.model) == doctest::Approx(1000 - 60));
}

TEST_CASE("3: a face with a hole, both polygons, lies in the outer one's plane") {
    StepText step;
    const auto polygon = [&](const std::vector<Point3>& corners) {
        std::vector<int> points;
        for (const Point3& p : corners) points.push_back(step.point(p));
        return step.bound(step.add("POLY_LOOP(''," + StepText::refs(points) + ")"));
    };
    // The hole first: order does not matter.
    const int hole = polygon({{1, 1, 5}, {1, 2, 5}, {2, 2, 5}, {2, 1, 5}});
    const int rim = polygon({{0, 0, 5}, {9, 0, 5}, {9, 9, 5}, {0, 9, 5}});
    const int face = step.add("FACE(''," + StepText::refs({hole, rim}) + ")");
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("FACETED_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Model model = imported(step).model;
    CHECK(near(std::get<Plane>(model.faces.at(0).surface).frame.z, {0, 0, 1}));
    CHECK(twice_area(model, model.faces[0]) == doctest::Approx(2 * (81 - 1)));
}

TEST_CASE("triangles 1: a tessellated solid") {
    StepText step;
    step.representation({tessellated_box(step)}, step.millimetres(),
                        "TESSELLATED_SHAPE_REPRESENTATION");
    const Imported result = imported(step);
    CHECK(result.diagnostics.empty());
    check_model(result.model);
    CHECK(result.model.solids.at(0).name == "mesh");
    CHECK(result.model.faces.size() == 12);
    CHECK(result.model.edges.size() == 18);
    CHECK(plane_volume(result.model) == doctest::Approx(3 * 4 * 5));
}

TEST_CASE("triangles 1: inside out, in metres") {
    StepText step;
    const int context = step.context({step.si_length("$"), step.radian()});
    step.representation({tessellated_box(step, 6, "$", true)}, context);
    const Imported result = imported(step);
    check_model(result.model);
    CHECK(plane_volume(result.model) == doctest::Approx(60e9));
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].severity == Severity::note);
}

TEST_CASE("triangles 1: strips, fans and indices into the points") {
    StepText step;
    const int points = step.add(coordinates({1, 2, 3}, {4, 6, 8}));
    // Four sides in one strip, the other two as fans; the strip ends with a triangle that is none.
    const std::string strip = "((1,5,2,6,4,8,3,7,1,5,5))", fans = "((1,2,4,3),(5,7,8,6))";
    const auto add = [&](const std::string& strips) {
        return step.add("COMPLEX_TRIANGULATED_FACE(''," + StepText::ref(points) +
                        ",8,(),$,(1,2,3,4,5,6,7,8)," + strips + "," + fans + ")");
    };
    const int solid = step.add("TESSELLATED_SHELL(''," + StepText::refs({add(strip)}) + ",$)");
    step.representation({solid}, step.millimetres());
    const Imported result = imported(step);
    check_model(result.model);
    CHECK(result.model.faces.size() == 12);
    CHECK(plane_volume(result.model) == doctest::Approx(3 * 4 * 5));
}

TEST_CASE("triangles 2: what does not close, or stands for an exact shape, is no solid") {
    StepText open;
    open.representation({tessellated_box(open, 5)}, open.millimetres());
    const Diagnostic error = refused(open);
    CHECK(error.status == ExitStatus::unsupported);
    CHECK(mentions(error, "do not close (4 sides"));

    StepText linked;
    const int exact = linked.box({0, 0, 0}, {1, 1, 1});
    const int context = linked.millimetres();
    linked.product("exact", linked.representation({exact}, context));
    const int mesh =
        linked.representation({tessellated_box(linked, 6, StepText::ref(exact))}, context);
    linked.product("its triangles", mesh);
    const Imported result = imported(linked);
    CHECK(result.model.solids.size() == 1);
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "stand for MANIFOLD_SOLID_BREP #"));
}

TEST_CASE(
    "triangles 2: of one product, the exact shape is taken; another product may be triangles") {
    StepText step;
    const int context = step.millimetres();
    const int exact = step.representation({step.box({0, 0, 0}, {1, 1, 1})}, context);
    const int approximate = step.representation({tessellated_box(step)}, context);
    const int definition = step.product("both", exact);
    const int shape = step.add("PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(definition) + ")");
    step.add("SHAPE_DEFINITION_REPRESENTATION(" + StepText::ref(shape) + "," +
             StepText::ref(approximate) + ")");
    step.product("triangles only", step.representation({tessellated_box(step)}, context));
    const Imported result = imported(step);
    REQUIRE(result.model.solids.size() == 2);
    CHECK(plane_volume(result.model) == doctest::Approx(1 + 60));
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "the exact shape beside it is taken"));
}

TEST_CASE("triangles 3: what cannot be read is named") {
    const auto error_of = [](const std::function<int(StepText&)>& face) {
        StepText step;
        const int item = face(step);
        const int solid = step.add("TESSELLATED_SOLID(''," + StepText::refs({item}) + ",$)");
        step.representation({solid}, step.millimetres());
        return refused(step);
    };
    const Diagnostic curved = error_of(
        [](StepText& step) { return step.add("CUBIC_BEZIER_TRIANGULATED_FACE('',$,0,(),$,())"); });
    CHECK(curved.status == ExitStatus::unsupported);
    CHECK(mentions(curved, "CUBIC_BEZIER_TRIANGULATED_FACE #"));
    const Diagnostic number = error_of([](StepText& step) {
        const int points = step.add(coordinates({0, 0, 0}, {1, 1, 1}));
        return step.add("TRIANGULATED_FACE(''," + StepText::ref(points) + ",8,(),$,(),((1,2,9)))");
    });
    CHECK(mentions(number, "no point number 9"));
    const Diagnostic pair = error_of([](StepText& step) {
        const int points = step.add(coordinates({0, 0, 0}, {1, 1, 1}));
        return step.add("TRIANGULATED_FACE(''," + StepText::ref(points) + ",8,(),$,(),((1,2)))");
    });
    CHECK(mentions(pair, "three indices"));
}
