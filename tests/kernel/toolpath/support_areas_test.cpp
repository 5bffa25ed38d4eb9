// Heights and gaps of support, in layers that are not of one thickness.

#include "kernel/toolpath/support_areas.h"

#include <doctest/doctest.h>

#include <vector>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

const Contours post{FullCircle{{0, 0}, 2, true}}, plate{FullCircle{{0, 0}, 8, true}};

// Post, plate and post again; the plate begins with `under`.
std::vector<SupportLevel> mushroom(const std::vector<double>& heights_mm, std::size_t under) {
    std::vector<SupportLevel> levels;
    double top = 0;
    for (std::size_t i = 0; i < heights_mm.size(); ++i) {
        const double bottom = top;
        top += heights_mm[i];
        levels.push_back({bottom, top, i < under ? Region(post) : Region(plate),
                          i == under ? Region(plate) : Region()});
    }
    return levels;
}

SupportAreas areas_of(const std::vector<SupportLevel>& levels, const SupportRequest& request) {
    std::vector<LayerRoom> rooms;
    for (std::size_t i = 0; i < levels.size(); ++i) rooms.push_back(room_of(levels, i, request));
    return support_areas(levels, rooms, request);
}

const std::vector<double> uneven{0.3, 0.2, 0.2, 0.1, 0.1, 0.15, 0.2, 0.2, 0.25, 0.2};

}  // namespace

TEST_CASE("support areas 1, 2: the air under an overhang is at least the gap, and no layer more") {
    for (const double gap : {0.0, 0.05, 0.1, 0.2, 0.21, 0.35, 0.6}) {
        CAPTURE(gap);
        for (std::size_t under = 5; under < uneven.size(); ++under) {
            const auto levels = mushroom(uneven, under);
            const SupportAreas areas =
                areas_of(levels, {.gap_z_mm = gap, .width_mm = 0.4, .allowed_mm = 1e-4});
            CHECK(areas.unresolved.empty());
            CHECK(areas.out_of_reach.empty());
            std::size_t highest = 0;
            for (std::size_t i = 0; i < levels.size(); ++i)
                if (!areas.layers[i].empty()) highest = i;
            CHECK(highest == highest_support(levels, under, gap));
            CHECK(levels[highest].top_mm <= levels[under].bottom_mm - gap + 1e-9);
            CHECK(levels[highest + 1].top_mm > levels[under].bottom_mm - gap + 1e-9);
            // A ring: from gap_xy beside the post to gap_xy beyond the plate.
            for (std::size_t i = 0; i <= highest; ++i)
                CHECK(total_area(areas.layers[i]) ==
                      doctest::Approx(pi * (8 * 8 - 2.4 * 2.4)).epsilon(1e-4));
        }
    }
}

TEST_CASE("support areas 4: what is within the gap over the bed is not supported") {
    const auto levels = mushroom({0.2, 0.2, 0.2}, 1);
    CHECK(highest_support(levels, 1, 0.2) == levels.size());
    const SupportAreas areas = areas_of(levels, {.allowed_mm = 1e-4});
    CHECK(areas.out_of_reach.empty());
    for (const Contours& layer : areas.layers) CHECK(layer.empty());
}

TEST_CASE(
    "support areas 3: sparse and dense are the layer, and as many layers dense as asked for") {
    const std::vector<double> even(20, 0.2);
    const auto levels = mushroom(even, 15);
    for (const std::size_t dense : {0u, 1u, 4u}) {
        const SupportRequest request{.interface_layers = dense, .allowed_mm = 1e-4};
        const SupportAreas areas = areas_of(levels, request);
        for (std::size_t i = 0; i < levels.size(); ++i) {
            CAPTURE(i);
            const DividedSupport parts = divided(areas.layers[i], levels, i, request);
            CHECK(parts.unresolved == 0);
            CHECK(total_area(parts.sparse) + total_area(parts.interface) ==
                  doctest::Approx(total_area(areas.layers[i])));
            const bool is_dense = i + dense > 13 && i <= 13;
            CHECK(parts.interface.empty() == !is_dense);
        }
    }
}
