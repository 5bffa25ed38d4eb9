// bench_orders: what it takes to put the layers of real parts in order, and how far the head travels then. Each layer
// has walls and unlinked lines of sparse fill; layers follow each other, so that seams have those below.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/part_layers.h"
#include "bench/table.h"
#include "kernel/toolpath/hatch.h"
#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/layer_order.h"
#include "kernel/toolpath/offset.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

struct Arguments {
    PartLayers parts{.layers = 150, .which = PartLayers::Which::from_bottom};
    std::uint32_t walls = 3;
    double width_mm = 0.45;
    double fill_pitch_mm = 2.8;  // 15 % of such lines
    SeamChoice seam = SeamChoice::aligned;
};

constexpr double quarter_turn_rad = 1.5707963267948966;

struct Layer {
    std::vector<Contour> region;
    std::vector<Strand> walls{};
    std::vector<std::uint32_t> depths{};
    std::vector<OpenPiece> pieces{};
};

struct Totals {
    FileCount files{};
    std::size_t layers = 0, walls = 0, segments = 0, pieces = 0;
    std::size_t ways = 0, bent = 0, cross = 0, cross_within = 0;
    double seams_s = 0, regions_s = 0, order_s = 0, ways_s = 0, longest_s = 0;
    double travel_mm = 0, made_mm = 0;
};

void add_fill(Region inside, std::size_t number, const Arguments& arguments, Layer& layer) {
    const double angle = (0.5 + static_cast<double>(number % 2)) * quarter_turn_rad;
    const Hatch lines = hatch(inside, angle, arguments.fill_pitch_mm);
    const Vector2 along = lines.direction, across(-along.y(), along.x());
    for (std::size_t row = 0; row < lines.row_count(); ++row) {
        const double aside = lines.first_offset_mm + static_cast<double>(row) * lines.pitch_mm;
        for (std::uint32_t k = lines.row_start[row]; k < lines.row_start[row + 1]; ++k) {
            layer.pieces.push_back({lines.spans[k].start_mm * along + aside * across,
                                    lines.spans[k].end_mm * along + aside * across});
        }
    }
}

Layer layer_of(std::vector<Contour> region, std::size_t number, const Arguments& arguments,
               double allowed_mm) {
    Layer layer{std::move(region)};
    for (std::uint32_t depth = 0; depth <= arguments.walls; ++depth) {
        const double inwards_mm = (depth + 0.5) * arguments.width_mm;
        const OffsetResult ring = offset(layer.region, {-inwards_mm, allowed_mm});
        if (depth == arguments.walls) {
            add_fill(ring.contours, number, arguments, layer);
            break;
        }
        for (const Contour& contour : ring.contours) {
            layer.walls.push_back({contour, arguments.width_mm});
            layer.depths.push_back(depth);
        }
    }
    return layer;
}

Point2 left_at(const Layer& layer, const PrintMove& move) {
    if (move.is_wall) return move.seam.point;
    return move.reversed ? layer.pieces[move.index].first : layer.pieces[move.index].last;
}

// Of the way to each move's start.
double travel_of(const Layer& layer, const std::vector<PrintMove>& moves) {
    double travel = 0;
    Point2 head = Point2::Zero();
    const auto go = [&](const Point2& to) {
        travel += (to - head).norm();
        head = to;
    };
    for (const PrintMove& move : moves) {
        for (const Point2& point : move.travel.via) go(point);
        go(move.seam.point);
        head = left_at(layer, move);
    }
    return travel;
}

// As the layer was made, each piece from its first end.
double travel_as_made(const Layer& layer) {
    std::vector<PrintMove> moves;
    for (std::uint32_t i = 0; i < layer.walls.size(); ++i)
        moves.push_back({true, i, false, {start_of(layer.walls[i].path)}});
    for (std::uint32_t i = 0; i < layer.pieces.size(); ++i)
        moves.push_back({false, i, false, {layer.pieces[i].first}});
    return travel_of(layer, moves);
}

void count_ways(const Layer& layer, const std::vector<PrintMove>& moves, Totals& totals) {
    const Islands islands(layer.region);
    std::uint32_t island = islands.count();
    for (const PrintMove& move : moves) {
        ++totals.ways;
        totals.bent += move.travel.via.empty() ? 0 : 1;
        const bool stays = islands.of(move.seam.point) == island;
        if (move.travel.crosses) ++(stays ? totals.cross_within : totals.cross);
        island = islands.of(left_at(layer, move));
    }
}

void measure(const Layer& layer, const Arguments& arguments, double allowed_mm,
             std::vector<Seam>& seams, Totals& totals) {
    ++totals.layers;
    totals.walls += layer.walls.size();
    totals.pieces += layer.pieces.size();
    for (const Strand& wall : layer.walls)
        totals.segments += count(wall.path).lines + count(wall.path).arcs;
    const double seams_s =
        time_of_s([&] { seams = outer_seams(layer.walls, layer.depths, arguments.seam, seams); });
    LayerPlan plan{layer.region, layer.walls, layer.depths, seams, layer.pieces};
    std::vector<PrintMove> moves = layer_order(plan);  // both that are timed find it in the cache
    const double order_s = time_of_s([&] { moves = layer_order(plan); });
    std::optional<Detours> detours;
    const double region_s = time_of_s([&] { detours.emplace(layer.region, allowed_mm); });
    plan.detours = &*detours;
    const double both_s = time_of_s([&] { moves = layer_order(plan); });
    totals.seams_s += seams_s;
    totals.order_s += order_s;
    totals.regions_s += region_s;
    totals.ways_s += both_s - order_s;
    totals.longest_s = std::max(totals.longest_s, seams_s + region_s + both_s);
    count_ways(layer, moves, totals);
    totals.travel_mm += travel_of(layer, moves);
    totals.made_mm += travel_as_made(layer);
}

void print(const Totals& totals) {
    const auto n = [](std::size_t value) { return std::to_string(value); };
    const double layers = static_cast<double>(std::max<std::size_t>(1, totals.layers));
    bench::print(Table{
        "Order of layers",
        {"what", "figure"},
        {{"files (and that cannot be read)",
          n(totals.files.read) + " (" + n(totals.files.unread) + ")"},
         {"layers", n(totals.layers)},
         {"walls, with segments", n(totals.walls) + ", " + n(totals.segments)},
         {"lines of fill", n(totals.pieces)},
         {"seams, a layer", duration(totals.seams_s / layers)},
         {"order, a layer", duration(totals.order_s / layers)},
         {"regions for detours, a layer", duration(totals.regions_s / layers)},
         {"ways, a layer", duration(totals.ways_s / layers)},
         {"the longest layer, all of it", duration(totals.longest_s)},
         {"ways, bent", n(totals.ways) + ", " + n(totals.bent)},
         {"crossing between parts, within one", n(totals.cross) + ", " + n(totals.cross_within)},
         {"travel, a layer", number(totals.travel_mm / layers) + " mm"},
         {"travel as made, a layer", number(totals.made_mm / layers) + " mm"}}});
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Order of layers: its time, and how far the head travels");
    add_options(app, arguments.parts);
    app.add_option("--walls", arguments.walls, "of each contour");
    app.add_option("--fill-pitch", arguments.fill_pitch_mm, "in mm");
    app.add_option("--seam", arguments.seam, "0 nearest, 1 rear, 2 aligned, 3 sharp");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    const double allowed_mm = slicer::Options{}.tolerance().total_mm;
    totals.files =
        for_parts(arguments.parts.files, [&](const std::string& name, const Model& model) {
            std::vector<Seam> seams;
            for (PartLayer& part : layers_of(name, model, arguments.parts))
                measure(layer_of(std::move(part.region), part.index, arguments, allowed_mm),
                        arguments, allowed_mm, seams, totals);
        });
    print(totals);
    return 0;
}
