// bench_skins: what it takes to find the skins and bridges of real parts, layer by layer, and whether they divide the
// inside without a rest. The walls are there only as the way in from the outline to the inside.

#include "kernel/toolpath/skins.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/step_files.h"
#include "bench/table.h"
#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/infill.h"
#include "kernel/toolpath/offset.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

struct Arguments {
    std::string files = LYR_FIXTURES "/parts";
    double layer_height_mm = 0.2;
    std::size_t layers = 400;  // of a file, at most: parts that have more are cut into thicker ones
    double walls = 3, width_mm = 0.45;
    std::size_t top_layers = 5, bottom_layers = 4;
    double min_sparse_mm2 = 10;
};

struct Totals {
    std::size_t files = 0, unread = 0, layers = 0, unresolved = 0, slivers = 0, with_rest = 0;
    std::size_t bridges = 0, overhangs = 0;
    double outlines_s = 0, skins_s = 0, bridges_s = 0, longest_s = 0;
    double top_mm2 = 0, bridge_mm2 = 0, solid_mm2 = 0, sparse_mm2 = 0, all_mm2 = 0;
};

struct Layer {
    std::vector<Contour> outline, inside;
};

std::vector<Layer> layers_of(const Model& model, const Tolerance& tolerance,
                             const Arguments& arguments) {
    const Cutter cutter(model, tolerance);
    const HeightRange range = cutter.height_range();
    const double height_mm = range.top_mm - range.bottom_mm;
    const double thickness_mm =
        std::max(arguments.layer_height_mm, height_mm / static_cast<double>(arguments.layers));
    const double spacing_mm = line_spacing_mm(arguments.width_mm, arguments.layer_height_mm);
    std::vector<Layer> layers;
    for (const double z_mm : slicer::layer_middles(height_mm, thickness_mm)) {
        auto section = slicer::region_of(cutter.cut(range.bottom_mm + z_mm), tolerance).contours;
        // Where faces of the model overlap a little, the section crosses itself.
        Layer layer{cleaned(section, tolerance.unite_mm()).contours, {}};
        const double inwards_mm = arguments.width_mm / 2 + arguments.walls * spacing_mm;
        layer.inside = offset(layer.outline, {-inwards_mm, tolerance.unite_mm()}).contours;
        layers.push_back(std::move(layer));
    }
    return layers;
}

void add_bridges(const LayerSkins& skins, Region below, const Arguments& arguments,
                 Totals& totals) {
    std::vector<Bridge> bridges;
    const double spacing_mm = line_spacing_mm(arguments.width_mm, arguments.layer_height_mm);
    totals.bridges_s += time_of_s([&] { bridges = bridges_over(skins.bridge, below, spacing_mm); });
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
    bench::print(
        Table{"Skins of layers",
              {"what", "figure"},
              {{"files (and that cannot be read)", n(totals.files) + " (" + n(totals.unread) + ")"},
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

void measure_file(const std::string& path, const Arguments& arguments, Totals& totals) {
    const slicer::Options options;
    Diagnostics found;
    const auto model = slicer::load(path, options, found);
    if (!model) {
        ++totals.unread;
        return;
    }
    ++totals.files;
    const Tolerance tolerance = options.tolerance();
    measure(std::filesystem::path(path).filename(), layers_of(*model, tolerance, arguments),
            tolerance.unite_mm(), arguments, totals);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Skins and bridges of real parts");
    app.add_option("--files", arguments.files, "a STEP file or a folder of them");
    app.add_option("--layer-height", arguments.layer_height_mm, "in mm");
    app.add_option("--layers", arguments.layers, "of a file, at most");
    app.add_option("--walls", arguments.walls, "how many");
    app.add_option("--top", arguments.top_layers, "layers");
    app.add_option("--bottom", arguments.bottom_layers, "layers");
    app.add_option("--min-sparse", arguments.min_sparse_mm2, "in mm2");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    for (const std::string& path : step_files(arguments.files)) {
        measure_file(path, arguments, totals);
        std::fflush(stdout);
    }
    print(totals);
    return totals.unresolved + totals.with_rest == 0 ? 0 : 1;
}
