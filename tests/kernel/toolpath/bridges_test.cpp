// Bridges of known spans, turned and mirrored.

#include "kernel/toolpath/bridges.h"

#include <doctest/doctest.h>

#include <limits>

#include "kernel/region/regions.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/skins.h"
#include "kernel/toolpath/stacks.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double lines_apart_mm = 0.4;

const std::vector<Motion> bridge_motions{
    {}, {0.4, {3, -7}}, {pi / 2, {0, 1}}, {1.1, {-20, 5}, true}, {-0.02, {0, 0}, true}};

void check_angle(const Contours& bridge, const Contours& below, double expected_rad) {
    for (const Motion& motion : bridge_motions) {
        CAPTURE(motion.angle_rad);
        const auto angle =
            bridge_angle(moved(bridge, motion), moved(below, motion), lines_apart_mm);
        REQUIRE(angle.has_value());
        CHECK(*angle >= 0);
        CHECK(*angle < pi);
        CHECK(apart(*angle, after(expected_rad, motion)) < 1e-6);
    }
}

// What skins make of a layer over another, with enough of both.
LayerSkins skins_over(const Contours& below, const Contours& above) {
    std::vector<Contours> layers(6, below);
    layers.insert(layers.end(), 6, above);
    std::vector<SkinOutline> outlines;
    for (const Contours& layer : layers) outlines.emplace_back(layer, width_mm);
    const Contours inside = offset(above, {-0.6, allowed_mm}).contours;
    return skins_of(outlines, 6, inside,
                    {.top_layers = 3,
                     .bottom_layers = 3,
                     .width_mm = width_mm,
                     .min_sparse_mm2 = 0,
                     .allowed_mm = allowed_mm});
}

}  // namespace

TEST_CASE("bridge: between two walls from one to the other, however long they are") {
    for (const double length : {4.0, 12.0, 60.0}) {
        const Contours below{rectangle(-5, 0, 0, length), rectangle(12, 0, 17, length)};
        check_angle({rectangle(-0.4, 0.5, 12.4, length - 0.5)}, below, 0);
    }
}

TEST_CASE("bridge: over a cavity along its shorter side") {
    const Contours below{rectangle(-5, -5, 19, 15), reversed(rectangle(0, 0, 14, 10))};
    check_angle({rectangle(-0.4, -0.4, 14.4, 10.4)}, below, pi / 2);
    // Not grown: lines are held just beyond their ends.
    check_angle({rectangle(0, 0, 14, 10)}, below, pi / 2);
}

TEST_CASE("bridge: held on three sides, across from the one to its opposite") {
    const Contours below{Path{
        {-3, -3},
        {{{13, -3}}, {{13, 8}}, {{10, 8}}, {{10, 0}}, {{0, 0}}, {{0, 8}}, {{-3, 8}}, {{-3, -3}}}}};
    check_angle({rectangle(-0.4, -0.4, 10.4, 7.5)}, below, 0);
}

TEST_CASE("bridge: over a slot with round ends across it") {
    const Contours below{rectangle(-10, -10, 40, 20), reversed(slot(0, 0, 30, 6))};
    for (const Motion& motion : bridge_motions) {
        const auto angle = bridge_angle(moved(Contours{slot(-0.4, -0.4, 30.4, 6.4)}, motion),
                                        moved(below, motion), lines_apart_mm);
        REQUIRE(angle.has_value());
        CHECK(apart(*angle, after(pi / 2, motion)) < 1e-6);
    }
}

TEST_CASE("bridge 3: what is held on one side only, or nowhere, is an overhang") {
    const Contours wall{rectangle(-5, 0, 0, 10)};
    for (const Motion& motion : bridge_motions) {
        const Contours below = moved(wall, motion);
        CHECK(!bridge_angle(moved(Contours{rectangle(-0.4, 0.5, 8, 9.5)}, motion), below,
                            lines_apart_mm));
        CHECK(!bridge_angle(moved(Contours{rectangle(3, 0.5, 8, 9.5)}, motion), below,
                            lines_apart_mm));
    }
    // A flange all round what holds it.
    const Contours ring{FullCircle{{0, 0}, 12, true}, FullCircle{{0, 0}, 7, false}};
    CHECK(!bridge_angle(ring, Contours{FullCircle{{0, 0}, 7.4, true}}, lines_apart_mm));
}

TEST_CASE("bridge: a ring between a post and a wall is held at both ends of most lines") {
    const Contours ring{FullCircle{{0, 0}, 12.4, true}, FullCircle{{0, 0}, 3.6, false}};
    const Contours below{rectangle(-20, -20, 20, 20), FullCircle{{0, 0}, 12, false},
                         FullCircle{{0, 0}, 4, true}};
    CHECK(bridge_angle(ring, below, lines_apart_mm).has_value());
}

TEST_CASE("bridge: a full circle has an extent across the line to its farthest point") {
    // Its boundary was seen at two points only, which lie on a row of the first direction.
    const Contours below{rectangle(-20, -20, 20, 20), FullCircle{{1, 2}, 5, false}};
    for (const double radius : {5.0, 5.4, 1e-3}) {
        const Contours bridge{FullCircle{{1, 2}, radius, true}};
        CHECK(bridge_angle(bridge, below, lines_apart_mm).has_value() == (radius > 4));
    }
    Path lens{{-4, 2}, {}};
    lens.segments.push_back(arc_with_sweep({-4, 2}, {6, 2}, pi / 2));
    lens.segments.push_back(arc_with_sweep({6, 2}, {-4, 2}, pi / 2));
    CHECK(bridge_angle(Contours{lens}, below, 2.5).has_value());
}

TEST_CASE("bridge: roofs and table tops that skins find are hatched across the air") {
    const Contours top{rectangle(0, 0, 30, 20)};
    const Contours cavity{rectangle(0, 0, 30, 20), reversed(rectangle(8, 5, 22, 15))};
    const auto over_cavity = bridges_over(skins_over(cavity, top).bridge, cavity, lines_apart_mm);
    REQUIRE(over_cavity.size() == 1);
    REQUIRE(over_cavity[0].angle_rad.has_value());
    CHECK(apart(*over_cavity[0].angle_rad, pi / 2) < 1e-6);

    const Contours walls{rectangle(0, 0, 30, 4), rectangle(0, 16, 30, 20)};
    const auto over_walls = bridges_over(skins_over(walls, top).bridge, walls, lines_apart_mm);
    REQUIRE(over_walls.size() == 1);
    REQUIRE(over_walls[0].angle_rad.has_value());
    CHECK(apart(*over_walls[0].angle_rad, pi / 2) < 1e-6);

    const Contours post{rectangle(0, 0, 10, 20)};
    const auto over_post = bridges_over(skins_over(post, top).bridge, post, lines_apart_mm);
    REQUIRE(over_post.size() == 1);
    CHECK(!over_post[0].angle_rad.has_value());
}

TEST_CASE("bridges: every part has its own direction, none is lost") {
    const Contours below{rectangle(-5, -5, 60, 30), reversed(rectangle(0, 0, 20, 8)),
                         reversed(rectangle(30, 0, 38, 20))};
    const Contours bridges{rectangle(-0.4, -0.4, 20.4, 8.4), rectangle(29.6, -0.4, 38.4, 20.4)};
    const auto found = bridges_over(bridges, below, lines_apart_mm);
    REQUIRE(found.size() == 2);
    CHECK(found[0].contours == Contours{bridges[0]});
    CHECK(found[1].contours == Contours{bridges[1]});
    CHECK(apart(found[0].angle_rad.value(), pi / 2) < 1e-6);
    CHECK(apart(found[1].angle_rad.value(), 0) < 1e-6);
}

TEST_CASE("bridges: nothing, and numbers that are not finite, have no direction") {
    const Contours plate{rectangle(0, 0, 10, 10)};
    const Contours broken{FullCircle{{0, 0}, std::numeric_limits<double>::infinity(), true}};
    CHECK(bridges_over({}, plate, lines_apart_mm).empty());
    CHECK(!bridge_angle({}, plate, lines_apart_mm));
    CHECK(!bridge_angle(broken, plate, lines_apart_mm));
    CHECK(!bridge_angle(plate, broken, lines_apart_mm));
    REQUIRE(bridges_over(plate, broken, lines_apart_mm).size() == 1);
}
