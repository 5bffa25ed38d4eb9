// bench_offsets: offsets of the layers of real parts beside those of a polygon library (Clipper 6, on polygons whose
// chords are a micrometre off the arcs at most). Prints every layer where they differ by more than both are off.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/step_files.h"
#include "bench/table.h"
#include "kernel/polygons.h"
#include "kernel/toolpath/offset.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace {

using namespace lyr;
using namespace lyr::bench;
using namespace lyr::testing;

struct Arguments {
    std::string files = LYR_FIXTURES "/parts";
    std::vector<double> distances_mm{-5, -2, -1, -0.6, -0.2, 0.2, 0.6, 2, 5};
    double layer_height_mm = 0.5;
    std::size_t layers = 20;  // of a file, at most
    double allowed_mm = 1e-4;
    bool polygons = true;
};

constexpr double chord_mm = 1e-3;

struct Totals {
    std::size_t files = 0, unread = 0, layers = 0, segments = 0, offsets = 0;
    std::size_t second_method = 0, unresolved = 0, slivers = 0;
    std::size_t areas_differ = 0, counts_differ = 0;
    double ours_s = 0, polygons_s = 0, worst_mm = 0;
    double longest_s = 0;
};

struct Layer {
    std::string name;
    double z_mm;
    std::vector<Contour> region;
    ClipperLib::Paths polygons;
};

// Contours that are no slivers: wider than what the two may differ by.
template <class Contours>
std::size_t count_wide(const Contours& contours, double width_mm) {
    return static_cast<std::size_t>(
        std::count_if(contours.begin(), contours.end(), [&](const auto& contour) {
            return 2 * std::abs(area_mm2(contour)) > width_mm * length_mm(contour);
        }));
}

void report(const Layer& layer, double distance_mm, const std::string& what) {
    std::printf("%s, z = %.4f, by %g mm: %s\n", layer.name.c_str(), layer.z_mm, distance_mm,
                what.c_str());
}

void compare(const Layer& layer, const std::vector<Contour>& contours, double distance_mm,
             const Arguments& arguments, Totals& totals) {
    ClipperLib::Paths theirs;
    totals.polygons_s +=
        time_of_s([&] { theirs = offset_polygons(layer.polygons, distance_mm, chord_mm); });
    // Chords of the region, of the library's arcs and of ours.
    const double apart_mm = 3 * chord_mm + arguments.allowed_mm;
    const ClipperLib::Paths ours = polygons(contours, chord_mm);
    const double length = (length_mm(ours) + length_mm(theirs)) / 2;
    if (length == 0) return;
    const double differ_mm = difference_mm2(ours, theirs) / length;
    totals.worst_mm = std::max(totals.worst_mm, differ_mm);
    if (differ_mm > apart_mm) {
        ++totals.areas_differ;
        report(layer, distance_mm, "areas differ by " + number(1000 * differ_mm) + " um");
    }
    const std::size_t our_count = count_wide(contours, 2 * apart_mm);
    const std::size_t their_count = count_wide(theirs, 2 * apart_mm);
    if (our_count != their_count) {
        ++totals.counts_differ;
        report(layer, distance_mm,
               std::to_string(our_count) + " contours, the library has " +
                   std::to_string(their_count));
    }
}

void measure(const Layer& layer, const Arguments& arguments, Totals& totals) {
    ++totals.layers;
    for (const Contour& contour : layer.region) {
        totals.segments += count(contour).lines + count(contour).arcs;
    }
    for (const double distance_mm : arguments.distances_mm) {
        ++totals.offsets;
        OffsetResult result;
        const double seconds = time_of_s([&] {
            result = offset(layer.region, {distance_mm, arguments.allowed_mm, Corner::round});
        });
        totals.ours_s += seconds;
        totals.longest_s = std::max(totals.longest_s, seconds);
        totals.slivers += result.slivers;
        totals.second_method += result.second_method;
        if (result.second_method) report(layer, distance_mm, "second method");
        if (result.unresolved) {
            ++totals.unresolved;
            report(layer, distance_mm,
                   "unresolved, kind " + std::to_string(static_cast<int>(result.unresolved->kind)));
        }
        if (arguments.polygons) compare(layer, result.contours, distance_mm, arguments, totals);
    }
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
    const Cutter cutter(*model, options.tolerance());
    const HeightRange range = cutter.height_range();
    const auto heights =
        slicer::layer_middles(range.top_mm - range.bottom_mm, arguments.layer_height_mm);
    const std::size_t taken = std::min(heights.size(), arguments.layers);
    for (std::size_t i = 0; i < taken; ++i) {
        const double z_mm = range.bottom_mm + heights[(2 * i + 1) * heights.size() / (2 * taken)];
        Layer layer{std::filesystem::path(path).filename(),
                    z_mm,
                    slicer::region_of(cutter.cut(z_mm), options.tolerance()).contours,
                    {}};
        if (layer.region.empty()) continue;
        if (arguments.polygons) layer.polygons = polygons(layer.region, chord_mm);
        measure(layer, arguments, totals);
    }
}

void print(const Totals& totals) {
    const auto n = [](std::size_t value) { return std::to_string(value); };
    const double offsets = static_cast<double>(totals.offsets);
    bench::print(Table{
        "Offsets of layers",
        {"what", "figure"},
        {{"files (and that cannot be read)", n(totals.files) + " (" + n(totals.unread) + ")"},
         {"layers, with segments", n(totals.layers) + ", " + n(totals.segments)},
         {"offsets", n(totals.offsets)},
         {"by the second method", n(totals.second_method)},
         {"unresolved", n(totals.unresolved)},
         {"slivers left out", n(totals.slivers)},
         {"areas differ from the library's", n(totals.areas_differ)},
         {"numbers of contours differ", n(totals.counts_differ)},
         {"greatest difference of areas, over the length", number(1000 * totals.worst_mm) + " um"},
         {"an offset", duration(totals.ours_s / offsets)},
         {"the longest", duration(totals.longest_s)},
         {"an offset, the library", duration(totals.polygons_s / offsets)}}});
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Offsets of layers beside those of a polygon library");
    app.add_option("--files", arguments.files, "a STEP file or a folder of them");
    app.add_option("--distances", arguments.distances_mm, "in mm, positive: outwards");
    app.add_option("--layer-height", arguments.layer_height_mm, "in mm");
    app.add_option("--layers", arguments.layers, "at most so many of a file, evenly spread");
    app.add_option("--allowed", arguments.allowed_mm, "in mm");
    app.add_flag("!--no-polygons", arguments.polygons, "ours only");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    for (const std::string& path : step_files(arguments.files)) {
        measure_file(path, arguments, totals);
        std::fflush(stdout);
    }
    print(totals);
    return totals.unresolved + totals.areas_differ == 0 ? 0 : 1;
}
