// Orders of whole layers: walls made by offsets, and lines as fill.

#include "kernel/toolpath/layer_order.h"

#include <doctest/doctest.h>

#include <map>

#include "kernel/region/regions.h"
#include "kernel/toolpath/hatch.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/wall_nests.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double ring_allowed_mm = 1e-3;

struct Layer {
    Contours region;
    std::vector<Strand> walls{};
    std::vector<std::uint32_t> depths{};
    std::vector<OpenPiece> pieces{};

    LayerPlan plan() const { return {region, walls, depths, {}, pieces}; }
};

Layer layer_of(const Contours& region, std::uint32_t wall_count) {
    Layer layer{region};
    for (std::uint32_t depth = 0; depth <= wall_count; ++depth) {
        const OffsetResult ring = offset(region, {-(depth + 0.5) * width_mm, ring_allowed_mm});
        if (depth < wall_count) {
            for (const Contour& contour : ring.contours) {
                layer.walls.push_back({contour, width_mm});
                layer.depths.push_back(depth);
            }
            continue;
        }
        const Hatch lines = hatch(ring.contours, 0.8, 3);
        const Vector2 along = lines.direction, across(-along.y(), along.x());
        for (std::size_t row = 0; row < lines.row_count(); ++row) {
            const double aside = lines.first_offset_mm + static_cast<double>(row) * lines.pitch_mm;
            for (std::uint32_t k = lines.row_start[row]; k < lines.row_start[row + 1]; ++k) {
                layer.pieces.push_back({lines.spans[k].start_mm * along + aside * across,
                                        lines.spans[k].end_mm * along + aside * across, 2});
            }
        }
    }
    return layer;
}

// Three plates with holes, one of them in a hole of another.
Contours plates() {
    return {rectangle(0, 0, 60, 40),        reversed(rectangle(5, 5, 25, 35)),
            FullCircle{{45, 20}, 8, false}, rectangle(8, 8, 22, 32),
            FullCircle{{15, 20}, 3, false}, FullCircle{{90, 20}, 15, true},
            FullCircle{{90, 20}, 5, false}};
}

Point2 end_of(const Layer& layer, const PrintMove& move) {
    if (move.is_wall) return move.seam.point;
    const OpenPiece& piece = layer.pieces[move.index];
    return move.reversed ? piece.first : piece.last;
}

Point2 start_of_move(const Layer& layer, const PrintMove& move) {
    if (move.is_wall) return move.seam.point;
    const OpenPiece& piece = layer.pieces[move.index];
    return move.reversed ? piece.last : piece.first;
}

double travel_mm(const Layer& layer, const std::vector<PrintMove>& moves) {
    double travel = 0;
    Point2 head = Point2::Zero();
    for (const PrintMove& move : moves) {
        for (const Point2& point : move.travel.via) {
            travel += (point - head).norm();
            head = point;
        }
        travel += (start_of_move(layer, move) - head).norm();
        head = end_of(layer, move);
    }
    return travel;
}

void check_complete(const Layer& layer, const std::vector<PrintMove>& moves) {
    CHECK(moves.size() == layer.walls.size() + layer.pieces.size());
    std::vector<bool> walls(layer.walls.size()), pieces(layer.pieces.size());
    for (const PrintMove& move : moves) {
        std::vector<bool>& seen = move.is_wall ? walls : pieces;
        REQUIRE(move.index < seen.size());
        CHECK(!seen[move.index]);
        seen[move.index] = true;
        if (move.is_wall)
            CHECK(distance_to({layer.walls[move.index].path}, move.seam.point) < 1e-9);
    }
}

// By windings counted by angles: how many of the outer contours are around it, in order.
std::size_t part_of(const Contours& region, const Point2& point) {
    std::size_t part = region.size();
    double least = 1e300;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const double area = area_mm2(region[i]);
        if (area <= 0 || area >= least || winding({region[i]}, point) == 0) continue;
        least = area;
        part = i;
    }
    return part;
}

}  // namespace

TEST_CASE("layer order 1, 2: everything once, part by part, walls before fill") {
    const Layer layer = layer_of(plates(), 3);
    const std::vector<PrintMove> moves = layer_order(layer.plan());
    check_complete(layer, moves);
    std::map<std::size_t, int> stage;  // by part
    std::size_t before = layer.region.size();
    for (const PrintMove& move : moves) {
        const std::size_t part = part_of(layer.region, start_of_move(layer, move));
        REQUIRE(part < layer.region.size());
        const int now = move.is_wall ? 0 : 2;
        if (part != before) CHECK(stage.count(part) == 0);
        CHECK(stage[part] <= now);
        stage[part] = now;
        before = part;
    }
    CHECK(stage.size() == 3);
}

TEST_CASE("layer order 3: walls from the inside outwards, or the reverse, side by side") {
    const Layer layer = layer_of(plates(), 3);
    for (const WallSequence sequence : {WallSequence::inner_first, WallSequence::outer_first}) {
        LayerPlan plan = layer.plan();
        plan.sequence = sequence;
        const std::vector<PrintMove> moves = layer_order(plan);
        check_complete(layer, moves);
        const bool inner_first = sequence == WallSequence::inner_first;
        std::uint32_t place = 0;  // within a nest
        for (const PrintMove& move : moves) {
            if (!move.is_wall) continue;
            CHECK(layer.depths[move.index] == (inner_first ? 2 - place : place));
            place = (place + 1) % 3;
        }
    }
}

TEST_CASE("layer order 3: a wall that splits has all its inner walls before it") {
    // Two squares and a bridge into which only one wall fits.
    const Contours dumbbell{Path{{0, 0},
                                 {{{10, 0}},
                                  {{10, 4.3}},
                                  {{20, 4.3}},
                                  {{20, 0}},
                                  {{30, 0}},
                                  {{30, 10}},
                                  {{20, 10}},
                                  {{20, 5.7}},
                                  {{10, 5.7}},
                                  {{10, 10}},
                                  {{0, 10}},
                                  {{0, 0}}}}};
    const Layer layer = layer_of(dumbbell, 3);
    const WallNests nests = wall_nests(layer.walls, layer.depths);
    CHECK(nests.roots.size() == 1);
    CHECK(std::count(layer.depths.begin(), layer.depths.end(), 2u) == 2);
    const std::vector<PrintMove> moves = layer_order(layer.plan());
    check_complete(layer, moves);
    std::vector<bool> printed(layer.walls.size());
    for (const PrintMove& move : moves) {
        if (!move.is_wall) continue;
        for (const std::uint32_t child : nests.children[move.index]) CHECK(printed[child]);
        printed[move.index] = true;
    }
}

TEST_CASE("layer order 4: outermost walls begin at their seams, inner ones beside them") {
    const Layer layer = layer_of(plates(), 3);
    for (const SeamChoice choice : {SeamChoice::rear, SeamChoice::sharp, SeamChoice::aligned}) {
        const std::vector<Seam> seams = outer_seams(layer.walls, layer.depths, choice, {});
        REQUIRE(seams.size() == layer.region.size());
        LayerPlan plan = layer.plan();
        plan.seams = seams;
        Point2 outer = Point2::Zero();
        plan.sequence = WallSequence::outer_first;
        for (const PrintMove& move : layer_order(plan)) {
            if (!move.is_wall) continue;
            const std::uint32_t depth = layer.depths[move.index];
            if (depth == 0) {
                outer = move.seam.point;
                CHECK(std::any_of(seams.begin(), seams.end(),
                                  [&](const Seam& seam) { return seam.point == outer; }));
            } else {
                CHECK((move.seam.point - outer).norm() < 2.5 * depth * width_mm);
            }
        }
        // The layer above, just like it, has its seams there.
        const std::vector<Seam> above =
            outer_seams(layer.walls, layer.depths, SeamChoice::aligned, seams);
        for (std::size_t i = 0; i < seams.size(); ++i)
            CHECK((above[i].point - seams[i].point).norm() < 1e-9);
    }
    CHECK(outer_seams(layer.walls, layer.depths, SeamChoice::nearest, {}).empty());
}

TEST_CASE("layer order 5: within a part no way crosses, between parts every one does") {
    const Layer layer = layer_of(plates(), 2);
    const Detours detours(layer.region, ring_allowed_mm, 1e9);
    LayerPlan plan = layer.plan();
    plan.detours = &detours;
    plan.head = {-5, -5};
    const std::vector<PrintMove> moves = layer_order(plan);
    std::size_t before = layer.region.size();
    int bent = 0;
    for (const PrintMove& move : moves) {
        const std::size_t part = part_of(layer.region, start_of_move(layer, move));
        CHECK(move.travel.crosses == (part != before));
        bent += move.travel.via.empty() ? 0 : 1;
        before = part;
    }
    CHECK(bent > 0);
}

TEST_CASE("layer order: travels far less than in the order in which all was made") {
    const Layer layer = layer_of(plates(), 3);
    double made_mm = 0;
    Point2 head = Point2::Zero();
    for (const Strand& wall : layer.walls) {
        made_mm += (start_of(wall.path) - head).norm();
        head = start_of(wall.path);
    }
    for (const OpenPiece& piece : layer.pieces) {
        made_mm += (piece.first - head).norm();
        head = piece.last;
    }
    CHECK(travel_mm(layer, layer_order(layer.plan())) < 0.4 * made_mm);
}

TEST_CASE("layer order: a layer of nothing, of walls alone and of pieces alone") {
    CHECK(layer_order({}).empty());
    Layer walls = layer_of(plates(), 2);
    Layer pieces = walls;
    walls.pieces.clear();
    check_complete(walls, layer_order(walls.plan()));
    pieces.walls.clear();
    pieces.depths.clear();
    check_complete(pieces, layer_order(pieces.plan()));
}

TEST_CASE("islands: a point is of the smallest part around it") {
    const Contours region = plates();
    const Islands islands(region);
    REQUIRE(islands.count() == 3);
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        const Point2 point(random.within(-5, 110), random.within(-5, 45));
        const std::size_t part = part_of(region, point);
        std::uint32_t expected = islands.count(), number = 0;
        for (std::size_t k = 0; k < region.size(); ++k) {
            if (area_mm2(region[k]) <= 0) continue;
            if (k == part) expected = number;
            ++number;
        }
        CHECK(islands.of(point) == expected);
    }
    CHECK(Islands(Contours{rectangle(0, 0, 1, 1)}).of({0.5, 0.5}) == 0);
}
