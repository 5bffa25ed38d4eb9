// bench_skins: what it takes to find the skins and bridges of real parts, layer by layer, and whether they divide the
// inside without a rest. The walls are there only as the way in from the outline to the inside.

#include "kernel/toolpath/skins.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/part_layers.h"
#include "bench/table.h"
#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/infill.h"
#include "kernel/toolpath/offset.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

struct Arguments {
    PartLayers parts{.layers = 400, .which = PartLayers::Which::thicker_ones};
    double walls = 3, width_mm = 0.45;
    std::size_t top_layers = 5, bottom_layers = 4;
    double min_sparse_mm2 = 10;
};

struct Totals {
    FileCount files{};
    std::size_t layers = 0, unresolved = 0, slivers = 0, with_rest = 0;
    std::size_t bridges = 0, overhangs = 0;
    double outlines_s = 0, skins_s = 0, bridges_s = 0, longest_s = 0;
    double top_mm2 = 0, bridge_mm2 = 0, solid_mm2 = 0, sparse_mm2 = 0, all_mm2 = 0;
};

struct Layer {
    std::vector<Contour> outline, inside;
};

double spacing_mm(const Arguments& arguments) {
    return line_spacing_mm(arguments.width_mm, arguments.parts.layer_height_mm);
}

std::vector<Layer> with_inside(std::vector<PartLayer> parts, double allowed_mm,
                               const Arguments& arguments) {
    const double inwards_mm = arguments.width_mm / 2 + arguments.walls * spacing_mm(arguments);
    std::vector<Layer> layers;
    for (PartLayer& part : parts) {
        auto inside = offset(part.region, {-inwards_mm, allowed_mm}).contours;
        layers.push_back({std::move(part.region), std::move(inside)});
    }
    return layers;
}

void add_bridges(const LayerSkins& skins, Region below, const Arguments& arguments,
                 Totals& totals) {
    std::vector<Bridge> bridges;
    totals.bridges_s +=
        time_of_s([&] { bridges = bridges_over(skins.bridge, below, spacing_mm(arguments)); });
    for (const Bridge& bridge : bridges) ++(bridge.angle_rad ? totals.bridges : totals.overhangs);
}

// How far the parts' areas together are from the inside's, over the length of its boundary and theirs.
double rest_mm(const LayerSkins& skins, Region inside) {
    double rest = area_mm2(inside), length = length_mm(inside);
    for (const auto* part :
         {&skins.top, &skins.bottom, &skins.bridge, &skins.solid, &skins.sparse}) {
        rest -= area_mm2(*part);
        length += length_mm(*part);
    }
    return length > 0 ? std::abs(rest) / length : 0;
}

void measure(const std::string& name, const std::vector<Layer>& layers, double allowed_mm,
             const Arguments& arguments, Totals& totals) {
    const SkinRequest request{.top_layers = arguments.top_layers,
                              .bottom_layers = arguments.bottom_layers,
                              .width_mm = arguments.width_mm,
                              .min_sparse_mm2 = arguments.min_sparse_mm2,
                              .allowed_mm = allowed_mm};
    std::vector<SkinOutline> outlines;
    totals.outlines_s += time_of_s([&] {
        for (const Layer& layer : layers) outlines.emplace_back(layer.outline, request.width_mm);
    });
    for (std::size_t i = 0; i < layers.size(); ++i) {
        LayerSkins skins;
        const double seconds =
            time_of_s([&] { skins = skins_of(outlines, i, layers[i].inside, request); });
        ++totals.layers;
        totals.skins_s += seconds;
        totals.longest_s = std::max(totals.longest_s, seconds);
        totals.unresolved += skins.unresolved;
        totals.slivers += skins.slivers;
        const double rest = rest_mm(skins, layers[i].inside);
        totals.with_rest += rest > allowed_mm;
        if (skins.unresolved > 0 || rest > allowed_mm)
            std::printf("%s, layer %zu: unresolved %zu, rest %g mm\n", name.c_str(), i,
                        skins.unresolved, rest);
        if (i > 0) add_bridges(skins, layers[i - 1].outline, arguments, totals);
        totals.top_mm2 += area_mm2(skins.top);
        totals.bridge_mm2 += area_mm2(skins.bridge);
        totals.solid_mm2 += area_mm2(skins.solid);
        totals.sparse_mm2 += area_mm2(skins.sparse);
        totals.all_mm2 += area_mm2(layers[i].inside);
    }
}

void print(const Totals& totals) {
    const auto n = [](std::size_t value) { return std::to_string(value); };
    const auto share = [&](double area) { return number(100 * area / totals.all_mm2) + " %"; };
    const auto a_layer = [&](double seconds) {
        return duration(seconds / static_cast<double>(totals.layers));
    };
    bench::print(Table{"Skins of layers",
                       {"what", "figure"},
                       {{"files (and that cannot be read)",
                         n(totals.files.read) + " (" + n(totals.files.unread) + ")"},
                        {"layers", n(totals.layers)},
                        {"unresolved", n(totals.unresolved)},
                        {"with a rest", n(totals.with_rest)},
                        {"slivers left out", n(totals.slivers)},
                        {"top skin", share(totals.top_mm2)},
                        {"bridges", share(totals.bridge_mm2)},
                        {"solid fill", share(totals.solid_mm2)},
                        {"sparse fill", share(totals.sparse_mm2)},
                        {"bridges that are held (and overhangs)",
                         n(totals.bridges) + " (" + n(totals.overhangs) + ")"},
                        {"outlines, a layer", a_layer(totals.outlines_s)},
                        {"skins, a layer", a_layer(totals.skins_s)},
                        {"the longest", duration(totals.longest_s)},
                        {"bridges, a layer", a_layer(totals.bridges_s)}}});
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Skins and bridges of real parts");
    add_options(app, arguments.parts);
    app.add_option("--walls", arguments.walls, "how many");
    app.add_option("--top", arguments.top_layers, "layers");
    app.add_option("--bottom", arguments.bottom_layers, "layers");
    app.add_option("--min-sparse", arguments.min_sparse_mm2, "in mm2");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    const double allowed_mm = slicer::Options{}.tolerance().unite_mm();
    totals.files = for_parts(arguments.parts.files, [&](const std::string& name,
                                                        const Model& model) {
        measure(name, with_inside(layers_of(name, model, arguments.parts), allowed_mm, arguments),
                allowed_mm, arguments, totals);
    });
    print(totals);
    return totals.unresolved + totals.with_rest == 0 ? 0 : 1;
}
