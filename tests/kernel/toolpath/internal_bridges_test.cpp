// Bridges inside of parts, by what must hold for every point of a layer.

#include "kernel/toolpath/internal_bridges.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/stacks.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

struct Bridged {
    Contours sparse_below;
    LayerSkins before, after;
};

// Layer by layer from the second one.
std::vector<Bridged> bridged(const std::vector<Contours>& layers, const Motion& motion = {},
                             const SkinRequest& request = usual_skins) {
    std::vector<Contours> outlines;
    for (const Contours& layer : layers) outlines.push_back(moved(layer, motion));
    std::vector<SkinOutline> seen;
    for (const Contours& outline : outlines) seen.emplace_back(outline, width_mm);
    std::vector<Bridged> result;
    Contours below;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Contours inside = offset(outlines[i], {-walls_mm, allowed_mm}).contours;
        const LayerSkins skins = skins_of(seen, i, inside, request);
        if (i > 0) {
            result.push_back({below, skins, skins});
            add_internal_bridges(result.back().after, below, request);
        }
        below = skins.sparse;
    }
    return result;
}

void check_point(const Bridged& layer, const Point2& point) {
    const Contours* const regions[] = {&layer.before.solid, &layer.before.top, &layer.after.solid,
                                       &layer.after.top, &layer.after.internal_bridge};
    for (const Contours* region : regions)
        if (distance_to(*region, point) < 4 * allowed_mm) return;
    const auto in = [&](const Contours& region) { return winding(region, point); };
    const int was = in(layer.before.solid) + in(layer.before.top);
    CHECK(in(layer.after.solid) + in(layer.after.top) + in(layer.after.internal_bridge) == was);
    CHECK(in(layer.after.solid) <= in(layer.before.solid));
    CHECK(in(layer.after.top) <= in(layer.before.top));
    if (was == 0) return;
    const double depth =
        std::max(depth_in(layer.before.solid, point), depth_in(layer.before.top, point));
    if (std::min(depth, depth_in(layer.sparse_below, point)) >
        internal_bridge_widths / 2 * width_mm + 4 * allowed_mm)
        CHECK(in(layer.after.internal_bridge) == 1);
    // Mitred anchors, and narrow strips beside them.
    if (depth_in(layer.sparse_below, point) < -4 * width_mm && depth > 2 * width_mm)
        CHECK(in(layer.after.internal_bridge) == 0);
}

void check_layers(const std::vector<Bridged>& layers, Random& random, int points) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
        CAPTURE(i);
        const auto& [sparse_below, before, after] = layers[i];
        CHECK(after.unresolved == 0);
        CHECK(after.sparse == before.sparse);
        CHECK(after.bridge == before.bridge);
        const double length = total_length(before.solid) + total_length(before.top) +
                              total_length(after.internal_bridge);
        CHECK(std::abs(total_area(after.solid) + total_area(after.top) +
                       total_area(after.internal_bridge) - total_area(before.solid) -
                       total_area(before.top)) <= allowed_mm * (1 + length));
        Contours all = before.solid;
        all.insert(all.end(), before.top.begin(), before.top.end());
        if (all.empty()) continue;
        const Eigen::AlignedBox2d box = box_of(all);
        for (int k = 0; k < points; ++k)
            check_point(layers[i], {random.within(box.min().x() - 1, box.max().x() + 1),
                                    random.within(box.min().y() - 1, box.max().y() + 1)});
    }
}

// A frustum with these radii at its bottom and its top.
std::vector<Contours> cone(double bottom_mm, double top_mm, int layers) {
    std::vector<Contours> result;
    for (int i = 0; i < layers; ++i) {
        const double radius = bottom_mm + (top_mm - bottom_mm) * (i + 0.5) / layers;
        result.push_back({FullCircle{{3, 1}, radius, true}});
    }
    return result;
}

std::vector<Chord> lines_along_x(double pitch_mm, const Motion& motion) {
    std::vector<Chord> lines;
    for (int i = -20; i <= 20; ++i)
        lines.push_back({motion({-100, i * pitch_mm + 0.3}), motion({100, i * pitch_mm + 0.3})});
    return lines;
}

}  // namespace

TEST_CASE(
    "internal bridges 1, 3: parts are divided without rest, and what lies on sparse fill is one") {
    Random random(3);
    for (const auto& layers : {staircase(), lens(), hollow_box()})
        for (const Motion& motion : motions) check_layers(bridged(layers, motion), random, 25);
}

TEST_CASE("internal bridges 1, 3: of layers that have nothing to do with each other") {
    Random random(4);
    for (int i = 0; i < 6; ++i) {
        std::vector<Contours> layers;
        for (int k = 0; k < 9; ++k)
            layers.push_back(random_region(random, {random.within(-2, 2), random.within(-2, 2)},
                                           random.within(8, 14)));
        check_layers(bridged(layers), random, 60);
    }
}

TEST_CASE("internal bridges: the first solid layer under a roof or step, and no other") {
    for (const Motion& motion : motions) {
        const auto layers = bridged(staircase(), motion);
        for (std::size_t i = 1; i < 20; ++i) {
            CAPTURE(i);
            const LayerSkins &skins = layers[i - 1].after, &before = layers[i - 1].before;
            // The step's top is layer 9, the roof layer 19, three layers each.
            if (i == 7 || i == 17) {
                CHECK(total_area(skins.internal_bridge) ==
                      doctest::Approx(total_area(before.solid)).epsilon(1e-6));
                CHECK(skins.solid.empty());
            } else {
                CHECK(skins.internal_bridge.empty());
                CHECK(skins.solid == before.solid);
            }
        }
    }
}

TEST_CASE("internal bridges: a single top layer is one itself") {
    SkinRequest single = usual_skins;
    single.top_layers = 1;
    const auto layers = bridged(std::vector<Contours>(8, {rectangle(0, 0, 20, 20)}), {}, single);
    CHECK(layers.back().after.top.empty());
    CHECK(total_area(layers.back().after.internal_bridge) == doctest::Approx(18.8 * 18.8));
}

TEST_CASE("internal bridges 1: what is narrower than a bridge stays solid") {
    for (const auto& [step_mm, is_bridged] : {std::pair(1.2, false), {1.5, true}}) {
        const LayerSkins wide{.solid = {rectangle(0, 0, 10, 10)}};
        LayerSkins skins = wide;
        add_internal_bridges(skins, Contours{rectangle(10 - step_mm, -5, 30, 15)}, usual_skins);
        CHECK(skins.internal_bridge.empty() != is_bridged);
        if (!is_bridged) CHECK(skins.solid == wide.solid);
        if (is_bridged)
            CHECK(total_area(skins.internal_bridge) ==
                  doctest::Approx(10 * (step_mm + width_mm)).epsilon(1e-6));
    }
}

TEST_CASE("internal bridges 2: no strip narrower than a line is left beside one") {
    // Solid below along the wall, a little wider than the anchor; then two lines wider.
    for (const auto& [band_mm, is_left] :
         {std::pair(1.8 * width_mm, false), {3 * width_mm, true}}) {
        LayerSkins skins{.solid = {rectangle(0, 0, 10, 10)}};
        add_internal_bridges(skins, Contours{rectangle(band_mm, 0, 10, 10)}, usual_skins);
        CHECK(skins.solid.empty() != is_left);
        CHECK(total_area(skins.solid) + total_area(skins.internal_bridge) == doctest::Approx(100));
    }
}

TEST_CASE("internal bridges 4: what is unresolved or out of range stays and is counted") {
    LayerSkins skins{.solid = {rectangle(0, 0, 10, 10)}};
    SkinRequest request = usual_skins;
    request.width_mm = 0;
    add_internal_bridges(skins, Contours{rectangle(0, 0, 10, 10)}, request);
    CHECK(skins.unresolved == 1);
    CHECK(skins.internal_bridge.empty());
    CHECK(total_area(skins.solid) == 100);
}

TEST_CASE("bridge 5: over parallel lines across them, however long that makes its own lines") {
    const Contours below{rectangle(-1, -1, 41, 11)}, inside{rectangle(0, 0, 40, 10)};
    for (const Motion& motion : motions) {
        for (const double pitch : {1.5, 2.5}) {
            const auto bridges =
                bridges_inside(moved(inside, motion), moved(below, motion), moved(inside, motion),
                               lines_along_x(pitch, motion), 0.4);
            REQUIRE(bridges.size() == 1);
            REQUIRE(bridges[0].angle_rad.has_value());
            CHECK(apart(*bridges[0].angle_rad, after(pi / 2, motion)) < 1e-6);
        }
        // Along the longer side, if the lines are across that.
        const Motion across{motion.angle_rad + pi / 2, motion.shift, motion.mirrored};
        const auto bridges = bridges_inside(moved(inside, motion), moved(below, motion),
                                            moved(inside, motion), lines_along_x(2.5, across), 0.4);
        REQUIRE(bridges[0].angle_rad.has_value());
        CHECK(apart(*bridges[0].angle_rad, after(0, motion)) < 1e-6);
    }
}

TEST_CASE("bridge 5: over nothing along the shorter side, and none where no side holds it") {
    const Contours below{rectangle(-1, -1, 41, 11)}, inside{rectangle(0, 0, 40, 10)};
    for (const Motion& motion : motions) {
        const auto held = bridges_inside(moved(inside, motion), moved(below, motion),
                                         moved(inside, motion), {}, 0.4);
        REQUIRE(held.size() == 1);
        REQUIRE(held[0].angle_rad.has_value());
        CHECK(apart(*held[0].angle_rad, after(pi / 2, motion)) < 1e-6);
        const auto floating = bridges_inside(moved(Contours{rectangle(10, 3, 20, 7)}, motion),
                                             moved(below, motion), moved(inside, motion), {}, 0.4);
        REQUIRE(floating.size() == 1);
        CHECK(!floating[0].angle_rad.has_value());
    }
}

TEST_CASE("bridge 5: chords of lines and arcs are as long as these") {
    Fill fill;
    fill.strands.push_back({FullCircle{{1, 2}, 3, true}, 0.4});
    fill.strands.push_back({Path{{0, 0}, {{{4, 3}}}}, 0.4});
    fill.runs.push_back({.direction = Vector2(0, 1),
                         .offset_mm = 2,
                         .pitch_mm = -0.5,
                         .rows = {{1, 3, false}, {1, 4, true}}});
    double length = 0;
    for (const Chord& chord : chords_of(fill)) length += (chord.to - chord.from).norm();
    CHECK(length == doctest::Approx(2 * pi * 3 + 5 + 2 + 3).epsilon(0.01));
    const std::vector<Chord> rows = chords_of({.runs = fill.runs});
    REQUIRE(rows.size() == 2);
    CHECK((rows[1].from - Point2(-1.5, 1)).norm() < 1e-12);
    CHECK((rows[1].to - Point2(-1.5, 4)).norm() < 1e-12);
}

TEST_CASE(
    "a ring too narrow for a line was left between walls and bridge, as its outer edge was not "
    "new") {
    std::size_t bridges = 0;
    for (const double top_mm : {2.0, 3.0, 5.0, 8.0, 11.0}) {
        for (const int layers : {20, 31, 44}) {
            for (const Bridged& layer : bridged(cone(16, top_mm, layers))) {
                bridges += !layer.after.internal_bridge.empty();
                if (layer.after.internal_bridge.empty()) continue;
                for (const Contours* after : {&layer.after.solid, &layer.after.top}) {
                    const Contours& before =
                        after == &layer.after.solid ? layer.before.solid : layer.before.top;
                    for (const Contours& part : parts_of(*after)) {
                        const bool is_old =
                            std::all_of(part.begin(), part.end(), [&](const Contour& c) {
                                return std::find(before.begin(), before.end(), c) != before.end();
                            });
                        CHECK((is_old || 2 * total_area(part) >= width_mm * total_length(part)));
                    }
                }
            }
        }
    }
    CHECK(bridges > 0);
}
