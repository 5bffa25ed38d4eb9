// Layers whose strands are what their sections ask for, and the same with something lost or laid twice.

#include "slicer/balance.h"

#include <doctest/doctest.h>

#include <numbers>

#include "kernel/toolpath/boundary.h"
#include "slicer/scene.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::span;
using Kind = Imbalance::Kind;

namespace {

Contour polygon(const std::vector<Point2>& corners, double turn_rad) {
    const Eigen::Rotation2Dd turn(turn_rad);
    Path path{turn * corners.back(), {}};
    for (const Point2& corner : corners) path.segments.push_back({turn * corner, 0});
    return path;
}

Contour square(double half_mm, double turn_rad) {
    return polygon(
        {{half_mm, -half_mm}, {half_mm, half_mm}, {-half_mm, half_mm}, {-half_mm, -half_mm}},
        turn_rad);
}

OutlinedLayer walled_with_figures(std::vector<Contour> outline) {
    OutlinedLayer layer{.outline = std::move(outline)};
    add_walls(layer, span, {});
    layer.printed = figures_of(layer.outline);
    return layer;
}

// With two bays that meet in a neck, of 0.6 mm.
std::vector<Contour> with_hole(double turn_rad) {
    const Contour hole = polygon({{-8.15, 0},
                                  {-4.15, 4},
                                  {-0.45, 0.3},
                                  {0.45, 0.3},
                                  {4.15, 4},
                                  {8.15, 0},
                                  {4.15, -4},
                                  {0.45, -0.3},
                                  {-0.45, -0.3},
                                  {-4.15, -4}},
                                 turn_rad);
    return {square(10, turn_rad), hole};
}

OutlinedLayer without_a_wall(OutlinedLayer layer) {
    layer.walls.strands.pop_back();
    layer.walls.depths.pop_back();
    return layer;
}

// All that the walls leave is sparse.
LayerFill sparse_within(const OutlinedLayer& layer) {
    return {.sparse = layer.walls.inside};
}

std::optional<Imbalance> found(const OutlinedLayer& layer, const LayerFill& fill,
                               const profile::Profile& profile = {}) {
    return imbalance_of(layer, fill, span, profile);
}

}  // namespace

TEST_CASE(
    "balance 1: walls and sparse fill, or solid fill with its flow, are what the section asks "
    "for") {
    for (const double turn : {0.0, 0.3, 1.7}) {
        CAPTURE(turn);
        const OutlinedLayer layer = walled_with_figures(with_hole(turn));
        REQUIRE(layer.walls.strands.size() == 6);
        CHECK(!found(layer, sparse_within(layer)));
        // Of the solid inside: one strand as wide as it, but for what flanks of lines share.
        const double inside_mm2 = area_mm2(layer.walls.inside);
        const double spacing_mm = 0.45 - 0.2 * (1 - std::numbers::pi / 4);
        const Path line{{-100, 0}, {{{-100 + inside_mm2 / spacing_mm / 2, 0}, 0}}};
        LayerFill solid{.pieces = {{format::Role::solid_infill, Strand{line, 0.45}, 2}}};
        CHECK(!found(layer, solid));
        // What is support, and what is sparse, is not the part's.
        solid.pieces.push_back({format::Role::sparse_infill, Strand{line, 0.45}, 2});
        solid.pieces.insert(solid.pieces.begin(), {format::Role::support, Strand{line, 0.45}, 2});
        solid.support = 1;
        CHECK(!found(layer, solid));
        solid.support = 0;
        CHECK(found(layer, solid)->kind == Kind::too_much);
    }
}

TEST_CASE("balance 2: any wall that is lost or laid twice is told, with how much and where") {
    for (const double turn : {0.0, 0.3, 1.7}) {
        const OutlinedLayer good = walled_with_figures(with_hole(turn));
        for (std::size_t i = 0; i < good.walls.strands.size(); ++i) {
            CAPTURE(turn);
            CAPTURE(i);
            const double length = length_mm(good.walls.strands[i].path);
            OutlinedLayer bad = good;
            bad.walls.strands.erase(bad.walls.strands.begin() + static_cast<long>(i));
            bad.walls.depths.erase(bad.walls.depths.begin() + static_cast<long>(i));
            const auto less = found(bad, sparse_within(good));
            REQUIRE(less);
            CHECK(less->kind == Kind::too_little);
            CHECK(less->off_mm2 == doctest::Approx(0.42 * length).epsilon(0.05));
            // Beside the wall.
            CHECK(Boundary({&good.walls.strands[i].path, 1}).distance_mm(less->at, 10) < 4);
            bad = good;
            bad.walls.strands.push_back(good.walls.strands[i]);
            bad.walls.depths.push_back(good.walls.depths[i]);
            const auto more = found(bad, sparse_within(good));
            if (0.4 * length < 0.1 * (good.printed.area_mm2 - area_mm2(good.walls.inside)))
                continue;
            REQUIRE(more);
            CHECK(more->kind == Kind::too_much);
            CHECK(more->off_mm2 == doctest::Approx(0.42 * length).epsilon(0.05));
        }
    }
}

TEST_CASE("balance 3: without gap fill nothing is missing") {
    const OutlinedLayer good = walled_with_figures(with_hole(0.3));
    profile::Profile profile;
    CHECK(found(without_a_wall(good), sparse_within(good), profile));
    profile.perimeters.gap_fill = false;
    CHECK(!found(without_a_wall(good), sparse_within(good), profile));
}

TEST_CASE("balance 1: what is told as too thin is not told again, nor what no layer has") {
    const OutlinedLayer good = walled_with_figures(with_hole(0));
    OutlinedLayer bad = without_a_wall(good);
    LayerFill fill = sparse_within(good);
    const auto missing = found(bad, fill);
    REQUIRE(missing);
    bad.walls.too_thin_mm2 = missing->off_mm2 / 2;
    fill.thin_left_out_mm2 = missing->off_mm2 / 2;
    CHECK(!found(bad, fill));
    CHECK(!found({}, {}));
}

TEST_CASE("balance 4: one warning for a run of layers, where it is worst") {
    const auto some = [](Kind kind, double off_mm2) {
        return std::optional(Imbalance{kind, off_mm2, 50, {off_mm2, 2}});
    };
    const std::vector<LayerSpan> spans = layer_spans(10, {});
    const auto said = [&](const std::vector<std::optional<Imbalance>>& layers) {
        BalanceReport report;
        for (std::size_t i = 0; i < layers.size(); ++i) report.add(layers[i], i);
        Diagnostics diagnostics;
        report.finish(spans, diagnostics);
        return diagnostics;
    };
    CHECK(said({std::nullopt, std::nullopt}).empty());
    const Diagnostics runs =
        said({std::nullopt, some(Kind::too_little, 2), some(Kind::too_little, 5),
              some(Kind::too_little, 1), std::nullopt, some(Kind::too_much, 10)});
    REQUIRE(runs.size() == 2);
    CHECK(runs[0].severity == Severity::warning);
    CHECK(runs[0].message ==
          "less is laid down than the part asks for in 3 layers, from z = 0.2 to 0.8 mm; most "
          "here, by 5 mm2 or 10 % of what is to be solid");
    CHECK(runs[0].where.layer == 3);
    CHECK(runs[0].where.x_mm == 5.0);
    CHECK(runs[0].where.y_mm == 2.0);
    CHECK(runs[0].where.z_mm == doctest::Approx(0.5));
    CHECK(runs[1].message.starts_with("more is laid down than the part asks for in 1 layer, from"));
    std::vector<std::optional<Imbalance>> many;
    for (int i = 0; i < 9; ++i) {
        many.push_back(some(Kind::too_little, 2));
        many.push_back(std::nullopt);
    }
    const Diagnostics first = said(many);
    REQUIRE(first.size() == 6);
    CHECK(
        first[0].message ==
        "less is laid down than the part asks for in 1 layer, from z = 0 to 0.2 mm; most here, by "
        "2 mm2 or 4 % of what is to be solid");
    CHECK(first[5].message == "so it is in 4 other runs of layers");
    CHECK(first[5].where.layer == 11);
}

TEST_CASE(
    "balance 2: of a part of a few square millimetres, a third could be missing or laid twice") {
    for (const double turn : {0.0, 0.3, 1.7}) {
        CAPTURE(turn);
        // One wall around, one within it.
        const OutlinedLayer good = walled_with_figures({square(0.86, turn)});
        REQUIRE(good.walls.strands.size() == 2);
        CHECK(!found(good, {}));
        const auto less = found(without_a_wall(good), {});
        REQUIRE(less);
        CHECK(less->kind == Kind::too_little);
        OutlinedLayer bad = good;
        bad.walls.strands.push_back(good.walls.strands.back());
        bad.walls.depths.push_back(1);
        const auto more = found(bad, {});
        REQUIRE(more);
        CHECK(more->kind == Kind::too_much);
    }
}
