// Landings and layers between them, beside what trying all gives.

#include "slicer/layer_sequence.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kernel/geometry/tolerance.h"

using namespace lyr;
using namespace lyr::slicer;

namespace {

// Steps of a ladder on which every choice is tried.
constexpr double rung_mm = 0.01;

FlatnessProfile random_profile(std::mt19937& random, double height_mm) {
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<FlatPart> parts;
    for (int i = 0; i < 6; ++i) {
        const double bottom = share(random) * height_mm;
        parts.push_back({bottom, bottom + 0.3 * share(random) * height_mm, share(random)});
    }
    return FlatnessProfile(parts);
}

bool is_allowed(const FlatnessProfile& flatness, double bottom, double top,
                const StepLimits& limits) {
    const double thickness = top - bottom;
    if (thickness < limits.thickness.least_mm - 2 * resolution_mm ||
        thickness > limits.thickness.most_mm + 2 * resolution_mm)
        return false;
    return thickness <= limits.thickness.least_mm + 2 * resolution_mm ||
           thickness * flatness.between(bottom, top) <= limits.depth_mm + 2 * resolution_mm;
}

// The fewest layers that end on rungs; 0: none do.
std::size_t fewest_on_rungs(double height_mm, const FlatnessProfile& flatness,
                            const StepLimits& limits) {
    const auto rungs = static_cast<std::size_t>(std::lround(height_mm / rung_mm));
    std::vector<std::size_t> fewest(rungs + 1, 0);
    const auto most = static_cast<std::size_t>(std::lround(limits.thickness.most_mm / rung_mm));
    for (std::size_t to = 1; to <= rungs; ++to) {
        for (std::size_t from = to > most ? to - most : 0; from < to; ++from) {
            if (from > 0 && fewest[from] == 0) continue;
            const double bottom = static_cast<double>(from) * rung_mm,
                         top = static_cast<double>(to) * rung_mm;
            if (!is_allowed(flatness, bottom, top, limits)) continue;
            if (fewest[to] == 0 || fewest[from] + 1 < fewest[to]) fewest[to] = fewest[from] + 1;
        }
    }
    return fewest[rungs];
}

}  // namespace

TEST_CASE("layer sequence 1, 2, 3: layers fill the height within their bounds, and none fewer do") {
    std::mt19937 random(11);
    std::size_t compared = 0;
    for (int i = 0; i < 150; ++i) {
        CAPTURE(i);
        const double height_mm = rung_mm * std::uniform_int_distribution<int>(10, 400)(random);
        const FlatnessProfile flatness = random_profile(random, height_mm);
        const StepLimits limits{0.06, {0.1, 0.3}};
        const auto tops = layer_tops(0, height_mm, flatness, limits);
        REQUIRE(!tops.empty());
        CHECK(tops.back() == height_mm);
        const std::size_t fewest = fewest_on_rungs(height_mm, flatness, limits);
        double bottom = 0;
        for (const double top : tops) {
            CHECK(top - bottom >= limits.thickness.least_mm - 2 * resolution_mm);
            CHECK(top - bottom <= limits.thickness.most_mm + 2 * resolution_mm);
            if (fewest > 0) CHECK(is_allowed(flatness, bottom, top, limits));
            bottom = top;
        }
        if (fewest == 0) continue;
        ++compared;
        CHECK(tops.size() <= fewest);
    }
    CHECK(compared > 100);
}

TEST_CASE("layer sequence 2: where no whole number of the thinnest fits, all give way alike") {
    const FlatnessProfile level({{0, 10, 1}});
    const StepLimits limits{0.05, {0.1, 0.3}};
    const auto tops = layer_tops(2, 3.05, level, limits);
    REQUIRE(tops.size() == 10);
    for (std::size_t i = 0; i < tops.size(); ++i)
        CHECK(tops[i] == doctest::Approx(2 + 0.105 * (static_cast<double>(i) + 1)));
}

TEST_CASE("layer sequence 4: on an upright wall all layers are as thick") {
    const StepLimits limits{0.05, {0.1, 0.3}};
    const auto tops = layer_tops(1, 3, FlatnessProfile({}), limits);
    REQUIRE(tops.size() == 7);
    for (std::size_t i = 0; i < tops.size(); ++i)
        CHECK(tops[i] == doctest::Approx(1 + 2.0 / 7 * (static_cast<double>(i) + 1)));
}

TEST_CASE("layer sequence: a part turned upside down has as many layers") {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 40; ++i) {
        std::vector<FlatPart> parts, turned;
        for (int k = 0; k < 5; ++k) {
            const double bottom = 8 * share(random), top = bottom + 2 * share(random);
            parts.push_back({bottom, top, share(random)});
            turned.push_back({10 - top, 10 - bottom, parts.back().flatness});
        }
        const StepLimits limits{0.04, {0.08, 0.32}};
        CHECK(layer_tops(0, 10, FlatnessProfile(parts), limits).size() ==
              layer_tops(0, 10, FlatnessProfile(turned), limits).size());
    }
}

TEST_CASE("landings 1: a whole number of layers of the thickness allowed") {
    const Thickness wide{0.1, 0.3}, narrow{0.25, 0.3}, one{0.2, 0.2};
    CHECK(fewest_layers(0.1, wide) == 1);
    CHECK(fewest_layers(0.0999, wide) == 0);
    CHECK(fewest_layers(0.3, wide) == 1);
    CHECK(fewest_layers(0.31, wide) == 2);
    CHECK(fewest_layers(30, wide) == 100);
    CHECK(fewest_layers(0.4, narrow) == 0);
    CHECK(fewest_layers(0.55, narrow) == 2);
    CHECK(fewest_layers(0.6, one) == 3);
    CHECK(fewest_layers(0.5, one) == 0);
}

TEST_CASE("landings 2: the highest height is landed on, or what is nearest") {
    const Thickness wide{0.1, 0.3};
    const auto ends = [&](std::vector<double> heights) { return landings(0.2, heights, wide); };
    CHECK(ends({5}) == std::vector<double>{5});
    CHECK(ends({0.23}).empty());
    CHECK(ends({0.27}) == std::vector<double>{0.30000000000000004});
    CHECK(ends({2, 5}) == std::vector<double>{2, 5});
    CHECK(ends({2, 2.05, 5}) == std::vector<double>{2, 5});
    CHECK(ends({4.97, 5}) == std::vector<double>{5});
    CHECK(ends({0.25, 0.4}) == std::vector<double>{0.4});
}

TEST_CASE("landings 3: none of all choices lands on more heights") {
    std::mt19937 random(13);
    for (int i = 0; i < 200; ++i) {
        CAPTURE(i);
        const Thickness allowed = i % 2 ? Thickness{0.1, 0.3} : Thickness{0.25, 0.35};
        std::uniform_real_distribution<double> height(0.31, 3);
        std::vector<double> heights;
        for (int k = 0; k < 9; ++k) heights.push_back(height(random));
        std::sort(heights.begin(), heights.end());
        const auto chosen = landings(0.3, heights, allowed);
        if (chosen.empty() || chosen.back() != heights.back()) continue;
        double before = 0.3;
        for (const double landing : chosen) {
            CHECK(fewest_layers(landing - before, allowed) > 0);
            before = landing;
        }
        std::size_t most = 0;
        for (unsigned subset = 0; subset < 1u << 8; ++subset) {
            double at = 0.3;
            std::size_t count = 0;
            bool fits = true;
            for (unsigned k = 0; k < 9; ++k) {
                if (k < 8 && !(subset >> k & 1)) continue;
                fits = fits && fewest_layers(heights[k] - at, allowed) > 0;
                at = heights[k];
                ++count;
            }
            if (fits) most = std::max(most, count);
        }
        CHECK(chosen.size() == most);
    }
}
