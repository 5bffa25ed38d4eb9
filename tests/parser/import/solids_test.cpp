// The numbers are those of the contract in parser/import/import.h.

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;

namespace {

void check_box(const Model& model, const Point3& low, const Point3& high) {
    check_model(model);
    CHECK(model.vertices.size() == 8);
    CHECK(model.edges.size() == 12);
    CHECK(model.faces.size() == 6);
    CHECK(near(box_of(model).min(), low));
    CHECK(near(box_of(model).max(), high));
    CHECK(plane_volume(model) == doctest::Approx((high - low).prod()));
}

}  // namespace

TEST_CASE("1, 3: a box, whatever way the flags state it") {
    for (int bits = 0; bits < 16; ++bits) {
        CAPTURE(bits);
        StepText step;
        const ShapeFlags flags{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0,
                               false};
        step.representation({step.box({1, 2, 3}, {4, 6, 8}, flags)}, step.millimetres());
        const Imported result = imported(step);
        CHECK(result.diagnostics.empty());
        check_box(result.model, {1, 2, 3}, {4, 6, 8});
        CHECK(result.model.solids.at(0).name == "box");
    }
}

TEST_CASE("a void that is larger than the outer shell is the outer shell (trj8_k1-ac-203)") {
    for (const bool exchanged : {false, true}) {
        CAPTURE(exchanged);
        StepText step;
        const int large = step.box_shell({0, 0, 0}, {10, 10, 10}, {});
        const int small = step.box_shell({2, 2, 2}, {5, 6, 7}, {});
        const int inner = step.add("ORIENTED_CLOSED_SHELL('',*," +
                                   StepText::ref(exchanged ? large : small) + ",.F.)");
        const int solid =
            step.add("BREP_WITH_VOIDS('hollow'," + StepText::ref(exchanged ? small : large) + ",(" +
                     StepText::ref(inner) + "))");
        step.representation({solid}, step.millimetres());
        const Imported result = imported(step);
        check_model(result.model);
        CHECK(plane_volume(result.model) == doctest::Approx(1000 - 3 * 4 * 5));
        const auto told = [](const Diagnostic& d) {
            return d.message.find("exchanged") != std::string::npos;
        };
        CHECK(std::any_of(result.diagnostics.begin(), result.diagnostics.end(), told) == exchanged);
    }
}

TEST_CASE(
    "a larger void that does not hold the outer shell is a solid beside it (trj8_k1-ac-203)") {
    StepText step;
    const int outer = step.box_shell({-5, 2, 2}, {5, 4, 4}, {});
    const int beside = step.box_shell({0, 0, 0}, {10, 10, 10}, {});
    const int inner = step.add("ORIENTED_CLOSED_SHELL('',*," + StepText::ref(beside) + ",.F.)");
    const int solid = step.add("BREP_WITH_VOIDS('hollow'," + StepText::ref(outer) + ",(" +
                               StepText::ref(inner) + "))");
    step.representation({solid}, step.millimetres());
    const Imported result = imported(step);
    check_model(result.model);
    CHECK(result.model.solids.size() == 2);
    CHECK(plane_volume(result.model) == doctest::Approx(1000 + 40));
}

TEST_CASE("a vertex that is not in the file is that of the edge next to it (bug31292)") {
    for (const int edge : {0, 5, 11}) {
        for (const int end : {1, 2}) {
            CAPTURE(edge);
            CAPTURE(end);
            StepText step;
            step.representation({step.box({1, 2, 3}, {4, 6, 8})}, step.millimetres());
            step.spoil("EDGE_CURVE", edge, end, "#18446744073709551615");
            const Imported result = imported(step);
            REQUIRE(result.diagnostics.size() == 1);
            CHECK(result.diagnostics[0].severity == Severity::warning);
            CHECK(mentions(result.diagnostics[0], "#18446744073709551615 is not defined"));
            check_box(result.model, {1, 2, 3}, {4, 6, 8});
        }
    }
    // Where no edge has it, there is nothing to stand in.
    StepText step;
    step.representation({step.box({1, 2, 3}, {4, 6, 8})}, step.millimetres());
    for (int edge = 0; edge < 12; ++edge) step.spoil("EDGE_CURVE", edge, 1, "#999999");
    CHECK(mentions(refused(step), "#999999 is not defined"));
}

TEST_CASE("1, 3: a cylinder with a seam") {
    StepText step;
    step.representation({step.cylinder(5, 12)}, step.millimetres());
    const Imported result = imported(step);
    const Model& model = result.model;
    CHECK(result.diagnostics.empty());
    check_model(model);
    CHECK(model.vertices.size() == 2);
    CHECK(model.edges.size() == 3);
    CHECK(model.faces.size() == 3);
    for (const Edge& edge : model.edges) {
        if (std::holds_alternative<Circle>(edge.curve)) {
            CHECK(std::abs(edge.t_end - edge.t_start) == doctest::Approx(2 * std::numbers::pi));
        }
    }
    for (const Face& face : model.faces) {
        if (std::holds_alternative<Plane>(face.surface)) {
            // 64 chords of a full circle of radius 5.
            const double polygon = 32 * 25 * std::sin(2 * std::numbers::pi / 64);
            CHECK(twice_area(model, face) / 2 == doctest::Approx(polygon));
        }
    }
}

TEST_CASE("1: voids look into the void, however their shell is stated") {
    // Files do not agree on whether the shell looks into the void before or after its orientation flag.
    for (int bits = 0; bits < 4; ++bits) {
        CAPTURE(bits);
        const bool inside_out = (bits & 1) != 0, orientation = (bits & 2) != 0;
        StepText step;
        const int outer = step.box_shell({0, 0, 0}, {10, 10, 10});
        std::vector<int> faces = step.box_faces({2, 2, 2}, {5, 6, 7});
        if (inside_out) {
            for (int& face : faces)
                face = step.add("ORIENTED_FACE('',*," + StepText::ref(face) + ",.F.)");
        }
        const int inner = step.add("CLOSED_SHELL(''," + StepText::refs(faces) + ")");
        const int oriented = step.add("ORIENTED_CLOSED_SHELL('',*," + StepText::ref(inner) + "," +
                                      StepText::flag(orientation) + ")");
        const int solid = step.add("BREP_WITH_VOIDS('hollow'," + StepText::ref(outer) + ",(" +
                                   StepText::ref(oriented) + "))");
        step.representation({solid}, step.millimetres());
        const Imported result = imported(step);
        check_model(result.model);
        REQUIRE(result.model.solids.size() == 1);
        CHECK(result.model.solids[0].shell_count == 2);
        CHECK(plane_volume(result.model) == doctest::Approx(1000 - 3 * 4 * 5));
        // What had to be turned around is told, but does not alarm.
        REQUIRE(result.diagnostics.size() == (inside_out == orientation ? 0 : 1));
        for (const Diagnostic& diagnostic : result.diagnostics) {
            CHECK(diagnostic.severity == Severity::note);
            CHECK(mentions(diagnostic, "ORIENTED_CLOSED_SHELL #"));
        }
    }
}

TEST_CASE("1: where same_sense contradicts the loops of a closed shell, the loops count") {
    StepText step;
    ShapeFlags flags;
    flags.senses_contradict = true;
    step.representation({step.box({1, 2, 3}, {4, 6, 8}, flags)}, step.millimetres());
    const Imported result = imported(step);
    check_box(result.model, {1, 2, 3}, {4, 6, 8});
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].severity == Severity::note);
    CHECK(mentions(result.diagnostics[0], "6 faces"));
}

TEST_CASE("1: a solid that is stated inside out is turned around") {
    StepText step;
    const int at = step.placement({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX());
    const int sphere = step.add("SPHERICAL_SURFACE(''," + StepText::ref(at) + ",4.)");
    const int shell =
        step.add("CLOSED_SHELL(''," + StepText::refs({step.face({}, sphere, false)}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Imported result = imported(step);
    CHECK(result.model.faces.at(0).same_sense);
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].severity == Severity::note);
}

TEST_CASE("1: the lemon inside a torus that crosses itself has its normal the other way in files") {
    StepText step;
    const int at = step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
    const int torus = step.add("TOROIDAL_SURFACE(''," + StepText::ref(at) + ",2.,5.)");
    const int plane = step.add("PLANE(''," + StepText::ref(at) + ")");
    const int v = step.vertex({3, 0, 0});
    const int rim = step.edge(v, v, step.add("CIRCLE(''," + StepText::ref(at) + ",3.)"));
    const int dome = step.face({step.bound(step.loop({step.oriented(rim, true)}))}, torus, false);
    const int floor = step.face({step.bound(step.loop({step.oriented(rim, false)}))}, plane, false);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({dome, floor}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    const Imported result = imported(step);
    CHECK(result.diagnostics.empty());
    check_model(result.model);
    const Face& face = result.model.faces.at(0);
    CHECK(face.same_sense);
    CHECK(normal(face.surface, invert(face.surface, {3, 0, 0.01})).x() > 0.9);
}

TEST_CASE("3, 5: surface models: closed shells are solids, open ones are marked") {
    StepText closed;
    const int shell =
        closed.add("OPEN_SHELL(''," + StepText::refs(closed.box_faces({0, 0, 0}, {1, 2, 3})) + ")");
    const int other = closed.box_shell({5, 5, 5}, {6, 6, 6});
    const int model =
        closed.add("SHELL_BASED_SURFACE_MODEL('skin'," + StepText::refs({shell, other}) + ")");
    closed.representation({model}, closed.millimetres(), "MANIFOLD_SURFACE_SHAPE_REPRESENTATION");
    const Imported result = imported(closed);
    check_model(result.model);
    CHECK(result.model.solids.size() == 2);
    CHECK(plane_volume(result.model) == doctest::Approx(6 + 1));

    CHECK(!result.model.shells.at(0).is_surface);
    CHECK(!result.model.shells.at(1).is_surface);

    // Two halves of a box that share edges, beside a whole one.
    StepText step;
    const std::vector<int> faces = step.box_faces({0, 0, 0}, {1, 2, 3});
    const int one = step.add("OPEN_SHELL(''," + StepText::refs({faces[0], faces[1]}) + ")");
    const int rest =
        step.add("OPEN_SHELL(''," + StepText::refs({faces[2], faces[3], faces[4], faces[5]}) + ")");
    const int whole = step.box_shell({5, 5, 5}, {6, 6, 6});
    const int halves =
        step.add("SHELL_BASED_SURFACE_MODEL('halves'," + StepText::refs({one, whole, rest}) + ")");
    step.representation({halves, step.box({0, 0, 0}, {1, 1, 1})}, step.millimetres());
    const Imported mixed = imported(step);
    CHECK(mixed.diagnostics.empty());
    REQUIRE(mixed.model.solids.size() == 3);
    CHECK(mixed.model.solids[0].shell_count == 1);
    CHECK(!mixed.model.shells[0].is_surface);
    CHECK(mixed.model.solids[1].name == "halves");
    CHECK(mixed.model.solids[1].shell_count == 2);
    CHECK(mixed.model.shells[1].is_surface);
    CHECK(mixed.model.shells[2].is_surface);
    CHECK(mixed.model.shells[1].face_count == 2);
    CHECK(mixed.model.shells[2].face_count == 4);
    CHECK(mixed.model.edges.size() == 3 * 12);
}

TEST_CASE("3: a surface model on the shell of a solid is not another solid") {
    StepText step;
    const int shell = step.box_shell({0, 0, 0}, {1, 1, 1});
    const int solid = step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")");
    const int skin = step.add("SHELL_BASED_SURFACE_MODEL(''," + StepText::refs({shell}) + ")");
    step.representation({skin, solid}, step.millimetres());
    CHECK(imported(step).model.solids.size() == 1);
}

TEST_CASE("3: a sphere of one face bounded by a vertex loop, or by nothing") {
    for (const bool bounded : {true, false}) {
        StepText step;
        const int at = step.placement({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX());
        const int sphere = step.add("SPHERICAL_SURFACE(''," + StepText::ref(at) + ",4.)");
        std::vector<int> bounds;
        if (bounded) {
            const int loop =
                step.add("VERTEX_LOOP(''," + StepText::ref(step.vertex({1, 2, -1})) + ")");
            bounds.push_back(step.bound(loop));
        }
        const int shell =
            step.add("CLOSED_SHELL(''," + StepText::refs({step.face(bounds, sphere)}) + ")");
        step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                            step.millimetres());
        const Model model = imported(step).model;
        REQUIRE(model.faces.size() == 1);
        CHECK(model.faces[0].loop_count == (bounded ? 1 : 0));
        CHECK(std::get<Sphere>(model.faces[0].surface).radius_mm == 4);
        if (bounded) CHECK(model.loops[0].coedge_count == 0);
    }
}

TEST_CASE("1: a solid in complex form") {
    StepText step;
    const int shell = step.box_shell({0, 0, 0}, {2, 2, 2});
    const int inner = step.box_shell({0.5, 0.5, 0.5}, {1, 1, 1});
    const int oriented = step.add("ORIENTED_CLOSED_SHELL('',*," + StepText::ref(inner) + ",.F.)");
    const int solid =
        step.add("(BREP_WITH_VOIDS((" + StepText::ref(oriented) +
                 "))GEOMETRIC_REPRESENTATION_ITEM()MANIFOLD_SOLID_BREP(" + StepText::ref(shell) +
                 ")REPRESENTATION_ITEM('complex')SOLID_MODEL())");
    step.representation({solid}, step.millimetres());
    const Model model = imported(step).model;
    CHECK(model.shells.size() == 2);
    CHECK(plane_volume(model) == doctest::Approx(8 - 0.125));
}

TEST_CASE("1: axes that are missing or parallel are chosen as the standard does") {
    const auto plane_frame = [](const std::string& axis, const std::string& reference) {
        StepText step;
        const int origin = step.point({0, 0, 0});
        const int at = step.add("AXIS2_PLACEMENT_3D(''," + StepText::ref(origin) + "," + axis +
                                "," + reference + ")");
        const int sphere = step.add("SPHERICAL_SURFACE(''," + StepText::ref(at) + ",1.)");
        step.define(900, "DIRECTION('',(0.,0.,2.))");
        step.define(901, "DIRECTION('',(3.,0.,0.))");
        step.define(902, "DIRECTION('',(1.,0.,1.))");
        const int shell =
            step.add("CLOSED_SHELL(''," + StepText::refs({step.face({}, sphere)}) + ")");
        step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                            step.millimetres());
        return std::get<Sphere>(imported(step).model.faces.at(0).surface).frame;
    };
    const auto is = [](const Frame& frame, const Vector3& z, const Vector3& x) {
        return near(frame.z, z) && near(frame.x, x) && near(frame.y, z.cross(x));
    };
    const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
    CHECK(is(plane_frame("$", "$"), z, x));
    CHECK(is(plane_frame("#901", "$"), x, y));
    CHECK(is(plane_frame("#900", "#900"), z, x));
    CHECK(is(plane_frame("#901", "#901"), x, y));
    CHECK(is(plane_frame("#900", "#902"), z, x));
    CHECK(is(plane_frame("$", "#902"), z, x));
}

TEST_CASE("faces keep the names that the file gives them, and need none") {
    StepText step;
    const int solid = step.box({1, 2, 3}, {4, 6, 8}, {});
    step.spoil("ADVANCED_FACE", 0, 0, "'roof \\X\\E4'");
    step.spoil("ADVANCED_FACE", 1, 0, "$");
    step.spoil("ADVANCED_FACE", 2, 0, ".ROOF.");
    step.representation({solid}, step.millimetres());
    const Imported result = imported(step);
    check_model(result.model);
    REQUIRE(result.model.face_names.size() == 1);
    const auto& [source, name] = *result.model.face_names.begin();
    CHECK(name == "roof \xc3\xa4");
    CHECK(std::count_if(result.model.faces.begin(), result.model.faces.end(),
                        [&](const Face& face) { return face.source == source; }) == 1);
}
