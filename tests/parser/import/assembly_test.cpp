// Assemblies, by the numbers of the contract in parser/import/import.h.

#include <doctest/doctest.h>

#include <numbers>

#include "checks.h"

using namespace lyr;
using namespace lyr::test;

namespace {

const Vector3 x_axis = Vector3::UnitX(), y_axis = Vector3::UnitY(), z_axis = Vector3::UnitZ();

// A product whose shape is a 1 x 2 x 3 box, and its representation's own placement.
struct Component {
    int definition, representation, origin;
};

Component box_component(StepText& step, int context) {
    const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
    const int solid = step.box({0, 0, 0}, {1, 2, 3});
    const int representation = step.representation({origin, solid}, context);
    return {step.product("block", representation), representation, origin};
}

Component assembly(StepText& step, const std::string& name, int context,
                   std::vector<int> placements) {
    const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
    placements.insert(placements.begin(), origin);
    const int representation = step.representation(placements, context, "SHAPE_REPRESENTATION");
    return {step.product(name, representation), representation, origin};
}

Eigen::AlignedBox3d box_of_solid(const Model& model, std::size_t solid) {
    Eigen::AlignedBox3d box;
    const Shell& shell = model.shells[model.solids[solid].first_shell];
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        const Loop& loop = model.loops[model.faces[f].first_loop];
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            box.extend(model[model[model.coedges[c].edge].start].point);
        }
    }
    return box;
}

bool spans(const Eigen::AlignedBox3d& box, const Point3& low, const Point3& high) {
    return near(box.min(), low) && near(box.max(), high);
}

}  // namespace

TEST_CASE("2: an occurrence is placed the same whichever way its relationship is written") {
    // Turned a quarter about z, then moved by (10, 0, 0): x to y, y to -x.
    for (const bool child_first : {true, false}) {
        for (const bool exchanged : {true, false}) {
            CAPTURE(child_first);
            CAPTURE(exchanged);
            StepText step;
            const int context = step.millimetres();
            const Component part = box_component(step, context);
            const int target = step.placement({10, 0, 0}, z_axis, y_axis);
            const Component whole = assembly(step, "whole", context, {target});
            const int first = child_first ? part.representation : whole.representation;
            const int second = child_first ? whole.representation : part.representation;
            const bool part_item_first = child_first != exchanged;
            step.occurrence(whole.definition, part.definition, first, second,
                            part_item_first ? part.origin : target,
                            part_item_first ? target : part.origin);
            const Imported result = imported(step);
            check_model(result.model);
            REQUIRE(result.model.solids.size() == 1);
            CHECK(spans(box_of(result.model), {8, 0, 0}, {10, 1, 3}));
        }
    }
}

TEST_CASE("2: a place in the assembly that is listed with the part (trj4_s1-ai-214)") {
    StepText step;
    const int context = step.millimetres();
    const int place = step.placement({10, 0, 0}, z_axis, y_axis);
    const int representation =
        step.representation({place, step.box({0, 0, 0}, {1, 2, 3})}, context);
    const int part = step.product("block", representation);
    const Component whole = assembly(step, "whole", context, {});
    step.occurrence(whole.definition, part, whole.representation, representation, place,
                    whole.origin);
    CHECK(spans(box_of(imported(step).model), {8, 0, 0}, {10, 1, 3}));
}

TEST_CASE("2: the component's own placement counts, not only the target") {
    StepText step;
    const int context = step.millimetres();
    const int own = step.placement({1, 1, 1}, z_axis, x_axis);
    const int representation = step.representation({own, step.box({0, 0, 0}, {1, 2, 3})}, context);
    const int part = step.product("block", representation);
    const int target = step.placement({100, 0, 0}, z_axis, x_axis);
    const Component whole = assembly(step, "whole", context, {target});
    step.occurrence(whole.definition, part, representation, whole.representation, own, target);
    CHECK(spans(box_of(imported(step).model), {99, -1, -1}, {100, 1, 2}));
}

TEST_CASE("2: a nested assembly has each part once for each way to it") {
    StepText step;
    const int context = step.millimetres();
    const Component part = box_component(step, context);
    const int left = step.placement({0, 0, 0}, z_axis, x_axis),
              right = step.placement({20, 0, 0}, z_axis, x_axis);
    const Component pair = assembly(step, "pair", context, {left, right});
    step.occurrence(pair.definition, part.definition, part.representation, pair.representation,
                    part.origin, left);
    step.occurrence(pair.definition, part.definition, part.representation, pair.representation,
                    part.origin, right);
    const int low = step.placement({0, 0, 0}, z_axis, x_axis),
              high = step.placement({0, 0, 50}, z_axis, x_axis);
    const Component whole = assembly(step, "whole", context, {low, high});
    for (const int at : {low, high}) {
        step.occurrence(whole.definition, pair.definition, pair.representation,
                        whole.representation, pair.origin, at);
    }
    const Model model = imported(step).model;
    check_model(model);
    REQUIRE(model.solids.size() == 4);
    CHECK(model.vertices.size() == 4 * 8);
    CHECK(plane_volume(model) == doctest::Approx(4 * 6));
    CHECK(spans(box_of_solid(model, 0), {0, 0, 0}, {1, 2, 3}));
    CHECK(spans(box_of_solid(model, 1), {20, 0, 0}, {21, 2, 3}));
    CHECK(spans(box_of_solid(model, 2), {0, 0, 50}, {1, 2, 53}));
    CHECK(spans(box_of_solid(model, 3), {20, 0, 50}, {21, 2, 53}));
}

TEST_CASE("1: an assembly in inches of a part in metres") {
    StepText step;
    const int metres = step.context({step.si_length("$")});
    const int inches =
        step.context({step.converted_length("INCH", 25.4, step.si_length(".MILLI."))});
    const Component part = box_component(step, metres);
    const int target = step.placement({10, 0, 0}, z_axis, x_axis);
    const Component whole = assembly(step, "whole", inches, {target});
    step.occurrence(whole.definition, part.definition, part.representation, whole.representation,
                    part.origin, target);
    CHECK(spans(box_of(imported(step).model), {254, 0, 0}, {1254, 2000, 3000}));
}

TEST_CASE("2: a product's shape may be in a representation beside its own") {
    StepText step;
    const int context = step.millimetres();
    const int solids = step.representation({step.box({0, 0, 0}, {1, 2, 3})}, context);
    const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
    const int shape = step.representation({origin}, context, "SHAPE_REPRESENTATION");
    step.add("SHAPE_REPRESENTATION_RELATIONSHIP('',''," + StepText::ref(shape) + "," +
             StepText::ref(solids) + ")");
    const int part = step.product("block", shape);
    const int target = step.placement({7, 0, 0}, z_axis, x_axis);
    const Component whole = assembly(step, "whole", context, {target});
    step.occurrence(whole.definition, part, shape, whole.representation, origin, target);
    const Model model = imported(step).model;
    REQUIRE(model.solids.size() == 1);
    CHECK(spans(box_of(model), {7, 0, 0}, {8, 2, 3}));
    CHECK(model.solids[0].name == "box");
}

TEST_CASE("2: mapped items place, turn, mirror and scale") {
    const auto mapped = [](const std::string& target) {
        StepText step;
        const int context = step.millimetres();
        const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
        const int source = step.representation(
            {origin, step.box({0, 0, 0}, {1, 2, 3}), step.cylinder(1, 2)}, context);
        const int map = step.add("REPRESENTATION_MAP(" + StepText::ref(origin) + "," +
                                 StepText::ref(source) + ")");
        step.define(1900, "CARTESIAN_POINT('',(10.,20.,30.))");
        step.define(1901, "DIRECTION('',(0.,1.,0.))");
        step.define(1902, "DIRECTION('',(-1.,0.,0.))");
        step.define(1903, "DIRECTION('',(0.,0.,1.))");
        step.define(1904, "DIRECTION('',(1.,0.,0.))");
        const int item = step.add("MAPPED_ITEM(''," + StepText::ref(map) + "," +
                                  StepText::ref(step.add(target)) + ")");
        step.representation({item}, context, "SHAPE_REPRESENTATION");
        const Model model = imported(step).model;
        check_model(model);
        REQUIRE(model.solids.size() == 2);
        return box_of_solid(model, 0);
    };
    // A quarter about z: x to y, y to -x.
    CHECK(spans(mapped("AXIS2_PLACEMENT_3D('',#1900,#1903,#1901)"), {8, 20, 30}, {10, 21, 33}));
    // The same, its y turned the other way: a mirroring, x to y and y to x.
    CHECK(spans(mapped("CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,#1901,#1904,#1900,1.,#1903)"),
                {10, 20, 30}, {12, 21, 33}));
    CHECK(spans(mapped("CARTESIAN_TRANSFORMATION_OPERATOR_3D('',#1901,#1902,#1900,2.,#1903)"),
                {6, 20, 30}, {10, 22, 36}));
    CHECK(spans(mapped("CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,$,#1900,$,$)"), {10, 20, 30},
                {11, 22, 33}));
    CHECK(spans(mapped("(CARTESIAN_TRANSFORMATION_OPERATOR(#1901,#1902,#1900,2.)"
                       "CARTESIAN_TRANSFORMATION_OPERATOR_3D(#1903)"
                       "FUNCTIONALLY_DEFINED_TRANSFORMATION('','')"
                       "GEOMETRIC_REPRESENTATION_ITEM()REPRESENTATION_ITEM(''))"),
                {6, 20, 30}, {10, 22, 36}));
}

TEST_CASE("2: an occurrence that is stated as a mapped item too is one") {
    StepText step;
    const int context = step.millimetres();
    const Component part = box_component(step, context);
    const int target = step.placement({10, 0, 0}, z_axis, x_axis);
    const int map = step.add("REPRESENTATION_MAP(" + StepText::ref(part.origin) + "," +
                             StepText::ref(part.representation) + ")");
    const int item =
        step.add("MAPPED_ITEM(''," + StepText::ref(map) + "," + StepText::ref(target) + ")");
    const Component whole = assembly(step, "whole", context, {target, item});
    step.occurrence(whole.definition, part.definition, part.representation, whole.representation,
                    part.origin, target);
    const Model model = imported(step).model;
    CHECK(model.solids.size() == 1);
    CHECK(spans(box_of(model), {10, 0, 0}, {11, 2, 3}));
}

TEST_CASE("2: a usage may have a representation of its own for its mapped item") {
    for (const bool listed_by_whole : {true, false}) {
        StepText step;
        const int context = step.millimetres();
        const Component part = box_component(step, context);
        const int target = step.placement({10, 0, 0}, z_axis, x_axis);
        const int map = step.add("REPRESENTATION_MAP(" + StepText::ref(part.origin) + "," +
                                 StepText::ref(part.representation) + ")");
        const int item =
            step.add("MAPPED_ITEM(''," + StepText::ref(map) + "," + StepText::ref(target) + ")");
        const Component whole = assembly(step, "whole", context,
                                         listed_by_whole ? std::vector{item} : std::vector<int>{});
        const int usage =
            step.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('','',''," + StepText::ref(whole.definition) +
                     "," + StepText::ref(part.definition) + ",$)");
        const int shape = step.add("PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(usage) + ")");
        const int of_usage = step.representation({item}, context, "SHAPE_REPRESENTATION");
        step.add("SHAPE_DEFINITION_REPRESENTATION(" + StepText::ref(shape) + "," +
                 StepText::ref(of_usage) + ")");
        // The whole stands within another, higher up.
        const int high = step.placement({0, 0, 50}, z_axis, x_axis);
        const Component top = assembly(step, "top", context, {high});
        step.occurrence(top.definition, whole.definition, whole.representation, top.representation,
                        whole.origin, high);
        const Imported result = imported(step);
        CHECK(result.diagnostics.empty());
        CHECK(result.model.solids.size() == 1);
        CHECK(spans(box_of(result.model), {10, 0, 50}, {11, 2, 53}));
    }
}

TEST_CASE("2: presentation does not place a part once more") {
    StepText step;
    const int context = step.millimetres();
    const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
    const int solid = step.box({0, 0, 0}, {1, 2, 3});
    const int shape = step.representation({origin, solid}, context);
    step.product("block", shape);
    const int map =
        step.add("REPRESENTATION_MAP(" + StepText::ref(origin) + "," + StepText::ref(shape) + ")");
    const int item =
        step.add("MAPPED_ITEM(''," + StepText::ref(map) + "," + StepText::ref(origin) + ")");
    step.representation({item}, context, "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION");
    step.representation({solid}, context, "DRAUGHTING_MODEL_REPRESENTATION");
    const Imported result = imported(step);
    CHECK(result.model.solids.size() == 1);
    CHECK(result.diagnostics.empty());
}

TEST_CASE("2: a named body of a part is the part's, and moves with it") {
    StepText step;
    const int context = step.millimetres();
    const int origin = step.placement({0, 0, 0}, z_axis, x_axis);
    const int solid = step.box({0, 0, 0}, {1, 2, 3});
    const int shape = step.representation({origin, solid}, context);
    const int definition = step.product("block", shape);
    const int property =
        step.add("PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(definition) + ")");
    const int aspect = step.add("SHAPE_ASPECT('body',''," + StepText::ref(property) + ",.F.)");
    const int of_aspect = step.add("PROPERTY_DEFINITION('',''," + StepText::ref(aspect) + ")");
    const int again = step.representation({solid}, context, "SHAPE_REPRESENTATION");
    step.add("SHAPE_DEFINITION_REPRESENTATION(" + StepText::ref(of_aspect) + "," +
             StepText::ref(again) + ")");
    const int target = step.placement({10, 0, 0}, z_axis, x_axis);
    const Component whole = assembly(step, "whole", context, {target});
    step.occurrence(whole.definition, definition, shape, whole.representation, origin, target);
    const Model model = imported(step).model;
    CHECK(model.solids.size() == 1);
    CHECK(spans(box_of(model), {10, 0, 0}, {11, 2, 3}));
}

TEST_CASE("2: the volume of a hole, as the shape of a feature, is no solid") {
    for (const std::string aspect_type : {"SHAPE_ASPECT('hole','',",
                                          "(CHARACTERIZED_OBJECT('','')ROUND_HOLE()"
                                          "SHAPE_ASPECT('hole','',"}) {
        StepText step;
        const int context = step.millimetres();
        const bool is_complex = aspect_type.front() == '(';
        const int feature = step.box({0, 0, 0}, {1, 2, 3});
        const int body = step.box({0, 0, 0}, {9, 9, 9});
        const int property = step.reserve();
        const int aspect =
            step.add(aspect_type + StepText::ref(property) + (is_complex ? ",.T.))" : ",.T.)"));
        const int of_aspect =
            step.add("PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(aspect) + ")");
        const int of_feature =
            step.representation({feature, body}, context, "SHAPE_REPRESENTATION");
        step.add("SHAPE_DEFINITION_REPRESENTATION(" + StepText::ref(of_aspect) + "," +
                 StepText::ref(of_feature) + ")");
        const int definition = step.product("block", step.representation({body}, context));
        step.define(property, "PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(definition) + ")");
        const Imported result = imported(step);
        REQUIRE(result.model.solids.size() == 1);
        CHECK(spans(box_of(result.model), {0, 0, 0}, {9, 9, 9}));
        REQUIRE(result.diagnostics.size() == 1);
        CHECK(result.diagnostics[0].severity == Severity::note);
        CHECK(mentions(result.diagnostics[0], "is the shape of a feature"));
    }
}

TEST_CASE("2: an occurrence without a placement stays where it is, with a warning") {
    StepText step;
    const int context = step.millimetres();
    const Component part = box_component(step, context);
    const Component whole = assembly(step, "whole", context, {});
    step.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('','',''," + StepText::ref(whole.definition) + "," +
             StepText::ref(part.definition) + ",$)");
    const Imported result = imported(step);
    CHECK(spans(box_of(result.model), {0, 0, 0}, {1, 2, 3}));
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "NEXT_ASSEMBLY_USAGE_OCCURRENCE #"));
}

TEST_CASE("2: a solid in no representation is found, in the file's only units") {
    StepText step;
    step.context({step.si_length(".CENTI.")});
    step.box({0, 0, 0}, {1, 2, 3});
    const Imported result = imported(step);
    CHECK(spans(box_of(result.model), {0, 0, 0}, {10, 20, 30}));
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(mentions(result.diagnostics[0], "in no representation"));
}

TEST_CASE("2: an assembly within itself is an error that names the cycle") {
    StepText step;
    const int context = step.millimetres();
    const Component part = box_component(step, context);
    const Component a = assembly(step, "a", context, {}), b = assembly(step, "b", context, {});
    step.occurrence(a.definition, part.definition, part.representation, a.representation,
                    part.origin, a.origin);
    step.occurrence(a.definition, b.definition, b.representation, a.representation, b.origin,
                    a.origin);
    step.occurrence(b.definition, a.definition, a.representation, b.representation, a.origin,
                    b.origin);
    const Diagnostic error = refused(step);
    CHECK(error.status == ExitStatus::input);
    CHECK(mentions(error, "itself"));
    CHECK(mentions(error, StepText::ref(a.representation)));
}

TEST_CASE("2: an assembly that doubles at each level ends with an error, not with the memory") {
    StepText step;
    const int context = step.millimetres();
    Component last = box_component(step, context);
    for (int level = 0; level < 60; ++level) {
        const int here = step.placement({0, 0, 0}, z_axis, x_axis),
                  there = step.placement({5, 0, 0}, z_axis, x_axis);
        const Component next = assembly(step, "level", context, {here, there});
        for (const int at : {here, there}) {
            step.occurrence(next.definition, last.definition, last.representation,
                            next.representation, last.origin, at);
        }
        last = next;
    }
    CHECK(mentions(refused(step), "places more than"));
}
