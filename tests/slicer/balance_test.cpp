// Layers whose strands are what their sections ask for, and the same with something lost or laid twice.

#include "slicer/balance.h"

#include <doctest/doctest.h>

#include <numbers>

#include "kernel/toolpath/boundary.h"

using namespace lyr;
using namespace lyr::slicer;
using Kind = Imbalance::Kind;

namespace {

constexpr LayerSpan span{0.2, 0.4};

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

OutlinedLayer walled(std::vector<Contour> outline) {
    OutlinedLayer layer{.outline = std::move(outline)};
    add_walls(layer, span, {});
    layer.printed = figures_of(layer.outline);
    return layer;
}

// Two holes like diamonds, tip to tip, a web of 0.3 mm between them; or one, without it.
std::vector<Contour> with_holes(bool has_web, double turn_rad) {
    std::vector<Contour> outline{square(10, turn_rad)};
    if (has_web) {
        for (const double x : {-8.15, 0.15})
            outline.push_back(polygon({{x, 0}, {x + 4, 4}, {x + 8, 0}, {x + 4, -4}}, turn_rad));
    } else {
        outline.push_back(polygon({{-8.15, 0},
                                   {-4.15, 4},
                                   {-0.45, 0.3},
                                   {0.45, 0.3},
                                   {4.15, 4},
                                   {8.15, 0},
                                   {4.15, -4},
                                   {0.45, -0.3},
                                   {-0.45, -0.3},
                                   {-4.15, -4}},
                                  turn_rad));
    }
    return outline;
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
        const OutlinedLayer layer = walled(with_holes(false, turn));
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
        const OutlinedLayer good = walled(with_holes(false, turn));
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

TEST_CASE("a web of 0.3 mm between two holes was lost without a word") {
    for (const double turn : {0.0, 0.3, 1.7}) {
        CAPTURE(turn);
        OutlinedLayer layer = walled(with_holes(true, turn));
        layer.walls = walled(with_holes(false, turn)).walls;
        const auto web = found(layer, sparse_within(layer));
        REQUIRE(web);
        // Too little for the sums.
        CHECK(web->kind == Kind::bare);
        CHECK(web->off_mm2 > 0.15);
        CHECK(web->off_mm2 < 0.4);
        CHECK(web->at.norm() < 0.5);
    }
}

TEST_CASE("balance 4: without gap fill nothing is missing") {
    OutlinedLayer layer = walled(with_holes(true, 0.3));
    layer.walls = walled(with_holes(false, 0.3)).walls;
    profile::Profile profile;
    profile.perimeters.gap_fill = false;
    CHECK(!found(layer, sparse_within(layer), profile));
}

TEST_CASE("balance 1: what is told as too thin is not told again, nor what no layer has") {
    OutlinedLayer layer = walled(with_holes(true, 0));
    layer.walls = walled(with_holes(false, 0)).walls;
    LayerFill fill = sparse_within(layer);
    layer.walls.too_thin_mm2 = 0.2;
    fill.thin_left_out_mm2 = 0.2;
    CHECK(!found(layer, fill));
    CHECK(!found({}, {}));
}

TEST_CASE("balance 5: one warning for a run of layers, where it is worst") {
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
              some(Kind::bare, 1), std::nullopt, some(Kind::too_much, 10)});
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
        many.push_back(some(Kind::bare, 0.2));
        many.push_back(std::nullopt);
    }
    const Diagnostics first = said(many);
    REQUIRE(first.size() == 6);
    CHECK(first[0].message ==
          "a spot that is to be solid has nothing in it in 1 layer, from z = 0 to 0.2 mm; largest "
          "here, 0.2 mm2");
    CHECK(first[5].message == "so it is in 4 other runs of layers");
    CHECK(first[5].where.layer == 11);
}
