// bench_fills: infill of the layers of real parts, a line a pattern and density: how long it takes, how many pieces it is,
// how much of the region it covers, and how far it leaves it.

#include "kernel/toolpath/fills.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/part_layers.h"
#include "bench/table.h"
#include "kernel/toolpath/offset.h"

namespace {

using namespace lyr;
using namespace lyr::bench;
using namespace lyr::testing;

struct Arguments {
    PartLayers parts{.layers = 10};
    double walls_mm = 1.3;  // three strands
    double width_mm = 0.45, overlap = 0.25;
    double allowed_mm = 0.005;
    bool coverage = false;
};

// Layers that are wider are left out: no printer of this kind makes them, and they would be most of the figures.
constexpr double widest_mm = 400;

struct Pattern {
    InfillPattern pattern;
    const char* name;
    double density;
};

constexpr Pattern patterns[] = {{InfillPattern::rectilinear, "rectilinear", 1},
                                {InfillPattern::concentric, "concentric", 1},
                                {InfillPattern::rectilinear, "rectilinear", 0.15},
                                {InfillPattern::grid, "grid", 0.15},
                                {InfillPattern::triangles, "triangles", 0.15},
                                {InfillPattern::concentric, "concentric", 0.15},
                                {InfillPattern::honeycomb, "honeycomb", 0.15},
                                {InfillPattern::gyroid, "gyroid", 0.15},
                                {InfillPattern::cubic, "cubic", 0.15}};

struct Totals {
    std::size_t layers = 0, pieces = 0, unresolved = 0, left_out = 0;
    double seconds = 0, longest_s = 0, astray_mm = 0;
    double area_mm2 = 0, covered_mm2 = 0;
};

struct Layer {
    std::size_t index;
    double z_mm;
    Contours inside, region;  // of the lines' middles; to be filled
};

double astray_mm(const Boundary& boundary, const Fill& fill) {
    constexpr double step_mm = 1, far_mm = 5;
    double astray = 0;
    for (const PrintedLine& line : lines_of(fill)) {
        const int steps = 2 + static_cast<int>(length_mm(line.start, line.segment) / step_mm);
        for (int i = 0; i <= steps; ++i) {
            const Point2 at = point_at(line.start, line.segment, static_cast<double>(i) / steps);
            if (boundary.winding(at) <= 0)
                astray = std::max(astray, boundary.distance_mm(at, far_mm));
        }
    }
    return astray;
}

void measure(const Layer& layer, const Pattern& pattern, const Arguments& arguments,
             Totals& totals) {
    constexpr double diagonal_rad = pi / 4;
    Fill fill;
    const double seconds = time_of_s([&] {
        fill = infill(layer.inside, {.pattern = pattern.pattern,
                                     .density = pattern.density,
                                     .width_mm = arguments.width_mm,
                                     .height_mm = arguments.parts.layer_height_mm,
                                     .angle_rad = diagonal_rad,
                                     .z_mm = layer.z_mm,
                                     .layer = layer.index,
                                     .allowed_mm = arguments.allowed_mm});
    });
    ++totals.layers;
    totals.seconds += seconds;
    totals.longest_s = std::max(totals.longest_s, seconds);
    totals.pieces += fill.runs.size() + fill.strands.size();
    totals.unresolved += fill.unresolved;
    totals.left_out += fill.left_out;
    totals.astray_mm = std::max(totals.astray_mm, astray_mm(Boundary(layer.inside), fill));
    if (arguments.coverage && pattern.density == 1) {
        const double area = total_area(layer.region);
        totals.area_mm2 += area;
        totals.covered_mm2 += area * covered_share(layer.region, fill, arguments.width_mm);
    }
}

void measure(const PartLayer& part, const Arguments& arguments, std::vector<Totals>& totals) {
    const auto inwards = [&](double distance_mm) {
        return offset(part.region, {-distance_mm, arguments.allowed_mm / 10}).contours;
    };
    const double middle_mm = arguments.walls_mm + (0.5 - arguments.overlap) * arguments.width_mm;
    const Layer layer{part.index, part.z_mm, inwards(middle_mm), inwards(arguments.walls_mm)};
    if (layer.inside.empty() || box_of(layer.inside).sizes().maxCoeff() > widest_mm) return;
    for (std::size_t p = 0; p < std::size(patterns); ++p)
        measure(layer, patterns[p], arguments, totals[p]);
}

// Round-off is nothing.
std::string micrometres(double length_mm) {
    constexpr double round_off_mm = 1e-9;
    return number(length_mm < round_off_mm ? 0 : 1000 * length_mm) + " um";
}

void print(const std::vector<Totals>& all, const Arguments& arguments) {
    Table table{"Infill of layers",
                {"pattern", "density", "layers", "a layer", "longest", "pieces", "astray",
                 "covered", "left out", "unresolved"},
                {}};
    for (std::size_t p = 0; p < all.size(); ++p) {
        const Totals& totals = all[p];
        const double layers = static_cast<double>(std::max<std::size_t>(totals.layers, 1));
        const bool covered = arguments.coverage && totals.area_mm2 > 0;
        table.rows.push_back(
            {patterns[p].name, number(patterns[p].density), std::to_string(totals.layers),
             duration(totals.seconds / layers), duration(totals.longest_s),
             number(static_cast<double>(totals.pieces) / layers), micrometres(totals.astray_mm),
             covered ? number(100 * totals.covered_mm2 / totals.area_mm2) + " %" : "",
             std::to_string(totals.left_out), std::to_string(totals.unresolved)});
    }
    bench::print(table);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Infill of the layers of real parts");
    add_options(app, arguments.parts);
    app.add_option("--walls", arguments.walls_mm, "in mm, around the infill");
    app.add_option("--overlap", arguments.overlap, "with the walls, of the strands' width");
    app.add_flag("--coverage", arguments.coverage, "of solid fill, on lines 10 um apart");
    CLI11_PARSE(app, argc, argv);

    std::vector<Totals> totals(std::size(patterns));
    for_parts(arguments.parts.files, [&](const std::string& name, const Model& model) {
        for (const PartLayer& part : layers_of(name, model, arguments.parts))
            measure(part, arguments, totals);
    });
    print(totals, arguments);
    return std::all_of(totals.begin(), totals.end(),
                       [](const Totals& of) { return of.unresolved == 0; })
               ? 0
               : 1;
}
