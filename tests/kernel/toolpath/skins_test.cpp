// Skins of stacks of layers, by what must hold for every point of them.

#include "kernel/toolpath/skins.h"

#include <doctest/doctest.h>

#include <limits>

#include "kernel/region/regions.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/stacks.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

struct Stack {
    std::vector<Contours> outlines, insides;

    explicit Stack(std::vector<Contours> layers, const Motion& motion = {}) {
        for (const Contours& layer : layers) {
            outlines.push_back(moved(layer, motion));
            insides.push_back(offset(outlines.back(), {-walls_mm, allowed_mm}).contours);
        }
    }

    std::vector<SkinOutline> skin_outlines() const {
        std::vector<SkinOutline> result;
        for (const Contours& outline : outlines) result.emplace_back(outline, width_mm);
        return result;
    }

    LayerSkins skins(std::size_t layer, const SkinRequest& request = usual_skins) const {
        return skins_of(skin_outlines(), layer, insides[layer], request);
    }
};

double area_of(const LayerSkins& skins) {
    return total_area(skins.top) + total_area(skins.bottom) + total_area(skins.bridge) +
           total_area(skins.solid) + total_area(skins.sparse);
}

// Where the least of the layers around it, none beyond the part, is over the point: how deep it is in that.
double depth_in_window(const Stack& stack, std::size_t layer, const Point2& point) {
    const std::size_t count = stack.outlines.size();
    if (layer < usual_skins.bottom_layers || layer + usual_skins.top_layers >= count) return -1e9;
    double depth = 1e9;
    for (std::size_t k = layer - usual_skins.bottom_layers; k <= layer + usual_skins.top_layers;
         ++k)
        depth = std::min(depth, depth_in(stack.outlines[k], point));
    return depth;
}

void check_point(const Stack& stack, std::size_t layer, const LayerSkins& skins,
                 const Point2& point) {
    const double inside = depth_in(stack.insides[layer], point);
    const Contours* const kinds[] = {&skins.top, &skins.bottom, &skins.bridge, &skins.solid,
                                     &skins.sparse};
    int in = 0;
    for (const Contours* kind : kinds) {
        if (std::abs(depth_in(*kind, point)) < 4 * allowed_mm) return;
        in += winding(*kind, point);
    }
    if (std::abs(inside) < 4 * allowed_mm) return;
    CHECK(in == (inside > 0 ? 1 : 0));
    if (inside <= 0) return;
    const double covered = depth_in_window(stack, layer, point);
    // Discs a little wider than a line, for what rows do not tell.
    if (std::min(inside, -covered) > 0.75 * width_mm) CHECK(winding(skins.sparse, point) == 0);
    // Mitres reach three widths.
    if (covered > 3 * width_mm) CHECK(winding(skins.sparse, point) == 1);
}

void check_stack(const Stack& stack, Random& random, int points) {
    for (std::size_t layer = 0; layer < stack.outlines.size(); ++layer) {
        CAPTURE(layer);
        const LayerSkins skins = stack.skins(layer);
        const Contours& inside = stack.insides[layer];
        CHECK(skins.unresolved == 0);
        CHECK(std::abs(area_of(skins) - total_area(inside)) <=
              allowed_mm * (1 + total_length(inside)));
        if (inside.empty()) continue;
        const Eigen::AlignedBox2d box = box_of(inside);
        for (int i = 0; i < points; ++i) {
            check_point(stack, layer, skins,
                        {random.within(box.min().x() - 1, box.max().x() + 1),
                         random.within(box.min().y() - 1, box.max().y() + 1)});
        }
    }
}

std::vector<Contours> table() {
    Contours legs;
    for (const double x : {0.0, 26.0})
        for (const double y : {0.0, 16.0}) legs.push_back(rectangle(x, y, x + 4, y + 4));
    std::vector<Contours> layers(8, legs);
    layers.insert(layers.end(), 8, {rectangle(0, 0, 30, 20)});
    return layers;
}

}  // namespace

TEST_CASE("skins 1, 2, 3: parts divide the inside, what is bare is solid, what is covered sparse") {
    Random random(3);
    for (const auto& layers : {staircase(), lens(), hollow_box(), table()})
        for (const Motion& motion : motions) check_stack(Stack(layers, motion), random, 25);
}

TEST_CASE("skins 1, 2, 3: of layers that have nothing to do with each other") {
    Random random(4);
    for (int i = 0; i < 6; ++i) {
        std::vector<Contours> layers;
        for (int k = 0; k < 9; ++k) {
            layers.push_back(random_region(random, {random.within(-2, 2), random.within(-2, 2)},
                                           random.within(8, 14)));
        }
        check_stack(Stack(layers), random, 60);
    }
}

TEST_CASE("skins: a step's top is bare on its last layer and solid on those below") {
    for (const Motion& motion : motions) {
        const Stack stack(staircase(), motion);
        const double step = (20 - 10 - walls_mm) * (10 - 2 * walls_mm);
        const double anchor = width_mm * (10 - 2 * walls_mm);
        CHECK(total_area(stack.skins(9).top) == doctest::Approx(step + anchor).epsilon(1e-4));
        CHECK(stack.skins(9).solid.empty());
        for (const std::size_t layer : {7, 8}) {
            CHECK(stack.skins(layer).top.empty());
            CHECK(total_area(stack.skins(layer).solid) ==
                  doctest::Approx(step + anchor).epsilon(1e-4));
        }
        CHECK(stack.skins(6).solid.empty());
        CHECK(stack.skins(10).solid.empty());
    }
}

TEST_CASE("skins: the first layer is all bottom, the last all top, those beside them solid") {
    const Stack stack(staircase());
    const auto all = [&](const Contours& part, std::size_t layer) {
        return part == stack.insides[layer];
    };
    CHECK(all(stack.skins(0).bottom, 0));
    CHECK(all(stack.skins(1).solid, 1));
    CHECK(all(stack.skins(2).sparse, 2));
    CHECK(all(stack.skins(16).sparse, 16));
    CHECK(all(stack.skins(17).solid, 17));
    CHECK(all(stack.skins(19).top, 19));
}

TEST_CASE("skins: over a cavity the roof is a bridge, its floor a top skin") {
    for (const Motion& motion : motions) {
        const Stack stack(hollow_box(), motion);
        const double cavity = 14 * 10, reach = (14 + 2 * width_mm) * (10 + 2 * width_mm);
        CHECK(total_area(stack.skins(14).bridge) == doctest::Approx(reach).epsilon(1e-4));
        CHECK(total_area(stack.skins(5).top) == doctest::Approx(reach).epsilon(1e-4));
        CHECK(total_area(stack.skins(15).solid) > cavity);
        CHECK(stack.skins(15).bridge.empty());
        for (std::size_t layer = 6; layer < 14; ++layer) {
            CHECK(stack.skins(layer).bridge.empty());
            CHECK(stack.skins(layer).sparse == stack.insides[layer]);
        }
    }
}

TEST_CASE("skins: none of the kinds that no layers are asked for") {
    const Stack stack(hollow_box());
    SkinRequest none = usual_skins;
    none.top_layers = none.bottom_layers = 0;
    for (std::size_t layer = 0; layer < stack.outlines.size(); ++layer)
        CHECK(stack.skins(layer, none).sparse == stack.insides[layer]);
}

TEST_CASE("skins: steps narrower than a line make nothing solid") {
    std::vector<Contours> layers;
    for (int i = 0; i < 12; ++i)
        layers.push_back({rectangle(0, 0, 30 - (walls_mm + 0.9 * width_mm) / 3 * i, 10)});
    const Stack stack(layers);
    for (std::size_t layer = 2; layer < 9; ++layer)
        CHECK(stack.skins(layer).sparse == stack.insides[layer]);
}

TEST_CASE("skins 2: gaps of two layers that are narrow each and side by side are solid together") {
    const double gap = 0.7 * width_mm;
    std::vector<Contours> layers(12, {rectangle(0, 0, 30, 10)});
    layers[6].push_back(reversed(rectangle(10, 2, 10 + gap, 8)));
    layers[7].push_back(reversed(rectangle(10 + gap, 2, 10 + 2 * gap, 8)));
    const LayerSkins skins = Stack(layers).skins(5);
    for (const double share : {0.2, 0.5, 0.9, 1.1, 1.5, 1.8})
        CHECK(winding(skins.sparse, {10 + share * gap, 5}) == 0);
    layers[7] = layers[8];
    CHECK(total_area(Stack(layers).skins(5).solid) == 0);
}

TEST_CASE("skins 4: small sparse parts are solid") {
    std::vector<Contours> layers(12, {rectangle(0, 0, 3, 3), rectangle(10, 0, 20, 10)});
    SkinRequest request = usual_skins;
    request.min_sparse_mm2 = 5;
    const Stack stack(layers);
    const LayerSkins skins = stack.skins(5, request);
    CHECK(total_area(skins.solid) == doctest::Approx(1.8 * 1.8));
    CHECK(total_area(skins.sparse) == doctest::Approx(8.8 * 8.8));
}

TEST_CASE("skins 4: a sparse part narrower than a line is solid") {
    const double narrow = 2 * walls_mm + 0.9 * width_mm, wide = 2 * walls_mm + 1.2 * width_mm;
    const Stack stack({12, {rectangle(0, 0, 30, narrow), rectangle(0, 5, 30, 5 + wide)}});
    const LayerSkins skins = stack.skins(5);
    CHECK(total_area(skins.solid) == doctest::Approx(28.8 * 0.9 * width_mm));
    CHECK(total_area(skins.sparse) == doctest::Approx(28.8 * 1.2 * width_mm));
}

TEST_CASE("skins 5: what is not finite is solid and counted") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Stack stack(staircase());
    stack.outlines[7].push_back(FullCircle{{nan, 0}, 1, true});
    const LayerSkins skins = stack.skins(6);
    CHECK(skins.unresolved == 1);
    CHECK(skins.solid == stack.insides[6]);
    CHECK(stack.skins(2).unresolved == 0);
    SkinRequest request = usual_skins;
    request.width_mm = 0;
    CHECK(Stack(staircase()).skins(5, request).unresolved == 1);
}

TEST_CASE("skins 6: outlines beyond the window do not matter") {
    for (const auto& layers : {staircase(), lens(), hollow_box()}) {
        const Stack stack(layers);
        for (std::size_t layer = 0; layer < layers.size(); ++layer) {
            auto outlines = stack.skin_outlines();
            for (std::size_t k = 0; k < outlines.size(); ++k)
                if (k + usual_skins.bottom_layers < layer || k > layer + usual_skins.top_layers)
                    outlines[k] = SkinOutline();
            const LayerSkins one = stack.skins(layer);
            const LayerSkins other = skins_of(outlines, layer, stack.insides[layer], usual_skins);
            CHECK(one.top == other.top);
            CHECK(one.bridge == other.bridge);
            CHECK(one.solid == other.solid);
            CHECK(one.sparse == other.sparse);
        }
    }
}

TEST_CASE("skins: of more different layers than are asked at once") {
    // Each has a notch of its own: none says what the others do.
    std::vector<Contours> layers;
    for (int i = 0; i < 20; ++i) {
        layers.push_back(
            {rectangle(0, 0, 80, 20), reversed(rectangle(2 + 3.7 * i, 5, 4 + 3.7 * i, 15))});
    }
    const Stack stack(layers);
    SkinRequest request = usual_skins;
    request.top_layers = request.bottom_layers = 6;
    const LayerSkins skins = stack.skins(10, request);
    CHECK(skins.unresolved == 0);
    CHECK(area_of(skins) == doctest::Approx(total_area(stack.insides[10])).epsilon(1e-6));
    for (int i = 4; i <= 16; ++i) {
        if (i != 10) CHECK(winding(skins.sparse, {3 + 3.7 * i, 10}) == 0);
    }
    CHECK(winding(skins.sparse, {3 + 3.7 * 2, 10}) == 1);
}
