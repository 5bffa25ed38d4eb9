// What is not understood or contradicts the standard: contract 4 and 5 in parser/import/import.h.

#include <doctest/doctest.h>

#include <functional>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;

namespace {

int plain_placement(StepText& step) {
    return step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
}

// A solid of one face, whose parts can be replaced.
struct Recipe {
    std::function<int(StepText&)> surface = [](StepText& s) {
        return s.add("PLANE(''," + StepText::ref(plain_placement(s)) + ")");
    };
    std::function<int(StepText&)> curve = [](StepText& s) {
        return s.add("CIRCLE(''," + StepText::ref(plain_placement(s)) + ",2.)");
    };
    std::function<int(StepText&, int vertex, int curve)> edge = [](StepText& s, int at, int along) {
        return s.edge(at, at, along);
    };
    std::function<int(StepText&, int edge)> use = [](StepText& s, int of) {
        return s.oriented(of, true);
    };
    std::function<int(StepText&, int use)> loop = [](StepText& s, int of) { return s.loop({of}); };
    std::function<int(StepText&, int loop)> bound = [](StepText& s, int of) { return s.bound(of); };
    std::function<int(StepText&, int bound, int surface)> face = [](StepText& s, int by, int on) {
        return s.face({by}, on);
    };
    std::function<int(StepText&, int face)> shell = [](StepText& s, int of) {
        return s.add("CLOSED_SHELL(''," + StepText::refs({of}) + ")");
    };
    std::function<int(StepText&, int shell)> solid = [](StepText& s, int of) {
        return s.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(of) + ")");
    };
};

Diagnostic error_of(const Recipe& recipe) {
    StepText step;
    const int vertex = step.vertex({2, 0, 0});
    const int use = recipe.use(step, recipe.edge(step, vertex, recipe.curve(step)));
    const int bound = recipe.bound(step, recipe.loop(step, use));
    const int solid =
        recipe.solid(step, recipe.shell(step, recipe.face(step, bound, recipe.surface(step))));
    step.representation({solid}, step.millimetres());
    return refused(step);
}

std::function<int(StepText&)> text(const std::string& instance) {
    return [instance](StepText& step) { return step.add(instance); };
}

void check_unsupported(const Diagnostic& error, const std::string& type) {
    CHECK(error.status == ExitStatus::unsupported);
    CHECK(mentions(error, type + " #"));
    CHECK(error.where.entity != 0);
    CHECK(error.where.line != 0);
}

void check_input(const Diagnostic& error, const std::string& expected) {
    CHECK(error.status == ExitStatus::input);
    CHECK(mentions(error, expected));
    CHECK(error.where.entity != 0);
}

}  // namespace

TEST_CASE("4: every surface that is not supported is named") {
    for (const std::string type : {"RECTANGULAR_COMPOSITE_SURFACE", "BLENDED_SURFACE"}) {
        Recipe recipe;
        recipe.surface = text(type + "('',$)");
        check_unsupported(error_of(recipe), type);
    }
    Recipe formless;
    formless.surface = text("(BOUNDED_SURFACE()ORIENTED_SURFACE(.T.)SURFACE())");
    CHECK(mentions(error_of(formless), "ORIENTED_SURFACE #"));
}

TEST_CASE("4: every curve that is not supported is named") {
    for (const std::string type : {"INTERSECTION_SPIRAL_CURVE", "CLOTHOID"}) {
        Recipe recipe;
        recipe.curve = text(type + "('',$)");
        check_unsupported(error_of(recipe), type);
    }
}

TEST_CASE("4: topology that is not supported is named") {
    Recipe recipe;
    recipe.edge = [](StepText& s, int, int) { return s.add("SUBEDGE('',$,$,$)"); };
    check_unsupported(error_of(recipe), "SUBEDGE");
    recipe = {};
    recipe.loop = [](StepText& s, int) { return s.add("POLY_LOOP('',())"); };
    check_input(error_of(recipe), "three points or more");
    recipe = {};
    recipe.face = [](StepText& s, int bound, int) {
        return s.add("FACE(''," + StepText::refs({bound}) + ")");
    };
    check_unsupported(error_of(recipe), "FACE");
}

TEST_CASE("4: solids of other kinds are named") {
    for (const std::string type :
         {"CSG_SOLID", "EXTRUDED_AREA_SOLID", "REVOLVED_AREA_SOLID", "SOLID_REPLICA"}) {
        Recipe recipe;
        recipe.solid = [&](StepText& s, int shell) {
            return s.add(type + "(''," + StepText::ref(shell) + ")");
        };
        check_unsupported(error_of(recipe), type);
    }
}

TEST_CASE("4: what refers to the wrong type says what it expected and found") {
    Recipe recipe;
    const auto circle = recipe.curve;
    recipe.surface = circle;
    check_input(error_of(recipe), "expected a surface, found CIRCLE #");
    recipe = {};
    recipe.curve = recipe.surface;
    check_input(error_of(recipe), "expected a curve, found PLANE #");
    recipe = {};
    recipe.use = [](StepText&, int edge) { return edge; };
    check_input(error_of(recipe), "expected ORIENTED_EDGE, found EDGE_CURVE #");
    recipe = {};
    recipe.bound = [](StepText&, int loop) { return loop; };
    check_input(error_of(recipe), "expected FACE_BOUND or FACE_OUTER_BOUND, found EDGE_LOOP #");
    recipe = {};
    recipe.loop = [](StepText&, int use) { return use; };
    check_input(error_of(recipe), "expected a loop, found ORIENTED_EDGE #");
    recipe = {};
    recipe.shell = [](StepText&, int face) { return face; };
    check_input(error_of(recipe), "expected a shell, found ADVANCED_FACE #");
    recipe = {};
    recipe.edge = [](StepText& s, int vertex, int curve) { return s.edge(curve, vertex, curve); };
    check_input(error_of(recipe), "expected VERTEX_POINT, found CIRCLE #");
    recipe = {};
    recipe.surface = [](StepText& s) {
        return s.add("PLANE(''," + StepText::ref(s.point({0, 0, 0})) + ")");
    };
    check_input(error_of(recipe), "expected AXIS2_PLACEMENT_3D, found CARTESIAN_POINT #");
}

TEST_CASE("4: wrong arguments are errors") {
    const auto surface_error = [](const std::function<int(StepText&)>& surface) {
        Recipe recipe;
        recipe.surface = surface;
        return error_of(recipe);
    };
    const auto sized = [](const std::string& type, const std::string& sizes) {
        return [=](StepText& s) {
            return s.add(type + "(''," + StepText::ref(plain_placement(s)) + "," + sizes + ")");
        };
    };
    check_input(surface_error(sized("CYLINDRICAL_SURFACE", "0.")), "positive radius");
    check_input(surface_error(sized("SPHERICAL_SURFACE", "-1.")), "positive radius");
    check_input(surface_error(sized("TOROIDAL_SURFACE", "1.,0.")), "positive radii");
    check_input(surface_error(sized("CONICAL_SURFACE", "1.,1.6")), "below 90 degrees");
    check_input(surface_error(sized("CONICAL_SURFACE", "0.,0.")), "neither radius nor semi-angle");
    check_input(surface_error(sized("CYLINDRICAL_SURFACE", "'wide'")), "CYLINDRICAL_SURFACE");
    check_input(surface_error(sized("CYLINDRICAL_SURFACE", "1.,2.,3.")), "arguments");
    check_input(surface_error(text("PLANE('',#999999)")), "999999");
    check_input(
        surface_error([](StepText& s) {
            const int o = s.add("CARTESIAN_POINT('',(1.,2.))");
            return s.add(
                "PLANE(''," +
                StepText::ref(s.add("AXIS2_PLACEMENT_3D(''," + StepText::ref(o) + ",$,$)")) + ")");
        }),
        "three numbers");
    check_input(surface_error([](StepText& s) {
                    const int o = s.point({0, 0, 0}), d = s.direction({0, 0, 0});
                    return s.add("PLANE(''," +
                                 StepText::ref(s.add("AXIS2_PLACEMENT_3D(''," + StepText::ref(o) +
                                                     "," + StepText::ref(d) + ",$)")) +
                                 ")");
                }),
                "no length");
    Recipe recipe;
    recipe.curve = sized("CIRCLE", "-2.");
    check_input(error_of(recipe), "must be positive");
    recipe = {};
    recipe.shell = [](StepText& s, int) { return s.add("CLOSED_SHELL('',())"); };
    check_input(error_of(recipe), "no faces");
    recipe = {};
    recipe.loop = [](StepText& s, int) { return s.add("EDGE_LOOP('',())"); };
    check_input(error_of(recipe), "no edges");
    recipe = {};
    recipe.face = [](StepText& s, int, int surface) { return s.face({}, surface); };
    check_input(error_of(recipe), "without bounds");
}

TEST_CASE("4: references in a circle are errors that name it") {
    Recipe recipe;
    recipe.curve = [](StepText& s) {
        const int a = s.reserve(), b = s.reserve();
        s.define(a, "SURFACE_CURVE(''," + StepText::ref(b) + ",(),.CURVE_3D.)");
        s.define(b, "TRIMMED_CURVE(''," + StepText::ref(a) + ",(),(),.T.,.PARAMETER.)");
        return a;
    };
    check_input(error_of(recipe), "itself");
    recipe = {};
    recipe.face = [](StepText& s, int, int) {
        const int a = s.reserve();
        s.define(a, "ORIENTED_FACE('',*," + StepText::ref(a) + ",.T.)");
        return a;
    };
    check_input(error_of(recipe), "itself");
    recipe = {};
    recipe.shell = [](StepText& s, int) {
        const int a = s.reserve();
        s.define(a, "ORIENTED_CLOSED_SHELL('',*," + StepText::ref(a) + ",.T.)");
        return a;
    };
    check_input(error_of(recipe), "itself");
}

TEST_CASE("5: a file without a solid is an error") {
    StepText nothing;
    nothing.add("CARTESIAN_POINT('',(0.,0.,0.))");
    CHECK(mentions(refused(nothing), "no solid in the file"));
    StepText wires;
    const int set = wires.add("GEOMETRIC_CURVE_SET(''," +
                              StepText::refs({wires.line({0, 0, 0}, {1, 0, 0})}) + ")");
    wires.representation({set}, wires.millimetres(),
                         "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION");
    CHECK(refused(wires).status == ExitStatus::input);
    CHECK(mentions(refused(wires), "only curves"));
}

TEST_CASE("5: curves and triangles beside a solid do not disturb it") {
    StepText step;
    const int context = step.millimetres();
    const int set = step.add("GEOMETRIC_CURVE_SET(''," +
                             StepText::refs({step.line({0, 0, 0}, {9, 0, 0})}) + ")");
    step.representation({set}, context, "SHAPE_REPRESENTATION");
    step.representation({step.add("TESSELLATED_SOLID('',(),$)")}, context,
                        "TESSELLATED_SHAPE_REPRESENTATION");
    step.representation({step.box({0, 0, 0}, {1, 1, 1})}, context);
    const Imported result = imported(step);
    CHECK(result.model.solids.size() == 1);
    CHECK(near(box_of(result.model).max(), {1, 1, 1}));
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "triangles"));
}
