// bench_offsets: offsets of the layers of real parts beside those of a polygon library (Clipper 6, on polygons whose
// chords are a micrometre off the arcs at most). Prints every layer where they differ by more than both are off.
//
// Where the region is known within e, its offset is so within 2 e: moving towards the boundary, the distance to it falls
// as fast as one moves, so a disc over which it stays within e of the offset's has a radius of 2 e at most. So the two
// results differ somewhere if a disc wider than that fits into what is in one of them only.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/part_layers.h"
#include "bench/table.h"
#include "kernel/polygons.h"
#include "kernel/toolpath/offset.h"

namespace {

using namespace lyr;
using namespace lyr::bench;
using namespace lyr::testing;

struct Arguments {
    PartLayers parts{.layer_height_mm = 0.5};
    std::vector<double> distances_mm{-5, -2, -1, -0.6, -0.2, 0.2, 0.6, 2, 5};
    double allowed_mm = 1e-4;
    double walls_mm = 0;  // their width
    bool polygons = true;
};

// What a slit or a neck narrower than the chords are off becomes is a matter of luck: where the results differ, they are
// compared again with finer chords.
constexpr double coarse_chord_mm = 1e-3, fine_chord_mm = 1e-5;

// The radius of a disc that may fit into the difference: for the chords of the region twice, for those of the library's
// arcs and of ours once, and what ours are allowed.
double apart_mm(double chord_mm, const Arguments& arguments) {
    return 4 * chord_mm + arguments.allowed_mm;
}

// Discs that fit into a difference are looked for from this radius on, each larger than the last by this factor.
constexpr double least_disc_mm = 0.1e-3;
constexpr double disc_factor = 1.25;

struct Totals {
    FileCount files{};
    std::size_t layers = 0, crossed = 0, segments = 0, offsets = 0;
    std::size_t second_method = 0, unresolved = 0, slivers = 0;
    std::size_t finer = 0, differ = 0, counts_differ = 0;
    double ours_s = 0, polygons_s = 0, worst_area_mm = 0, worst_mm = 0;
    double longest_s = 0;
};

void report(const PartLayer& layer, double distance_mm, const std::string& what) {
    std::printf("%s, z = %.4f, by %g mm: %s\n", layer.part.c_str(), layer.z_mm, distance_mm,
                what.c_str());
}

// The radius of the largest disc that fits into polygons, at most disc_factor too large.
double widest_mm(const ClipperLib::Paths& polygons) {
    double radius = least_disc_mm;
    while (!offset_polygons(polygons, -radius, radius / 10).empty()) radius *= disc_factor;
    return radius;
}

struct Comparison {
    double widest_mm = 0, area_mm = 0;  // the area of what is in one only, over the length
    std::size_t our_count = 0, their_count = 0;
    double library_s = 0;
};

Comparison compared(const PartLayer& layer, Region contours, double distance_mm, double chord_mm,
                    const Arguments& arguments) {
    Comparison result;
    ClipperLib::Paths theirs;
    const ClipperLib::Paths region = polygons(layer.region, chord_mm);
    result.library_s = time_of_s([&] { theirs = offset_polygons(region, distance_mm, chord_mm); });
    const ClipperLib::Paths ours = polygons(contours, chord_mm);
    const double length = (length_mm(ours) + length_mm(theirs)) / 2;
    if (length == 0) return result;
    const ClipperLib::Paths difference = difference_of(ours, theirs);
    result.widest_mm = widest_mm(difference);
    result.area_mm = area_mm2(difference) / length;
    // Of what is left without a margin: where parts touch, they may be one or two.
    const double margin_mm = 2 * apart_mm(chord_mm, arguments);
    const auto count = [&](const ClipperLib::Paths& paths) {
        return offset_polygons(paths, -margin_mm, margin_mm / 10).size();
    };
    result.our_count = count(ours);
    result.their_count = count(theirs);
    return result;
}

void compare(const PartLayer& layer, Region contours, double distance_mm,
             const Arguments& arguments, Totals& totals) {
    double chord_mm = coarse_chord_mm;
    Comparison found = compared(layer, contours, distance_mm, chord_mm, arguments);
    totals.polygons_s += found.library_s;
    const auto differ = [&] {
        return found.widest_mm > disc_factor * apart_mm(chord_mm, arguments);
    };
    if (differ() || found.our_count != found.their_count) {
        ++totals.finer;
        chord_mm = fine_chord_mm;
        found = compared(layer, contours, distance_mm, chord_mm, arguments);
    }
    totals.worst_area_mm = std::max(totals.worst_area_mm, found.area_mm);
    totals.worst_mm = std::max(totals.worst_mm, found.widest_mm);
    if (differ()) {
        ++totals.differ;
        report(layer, distance_mm,
               "a disc of " + number(1000 * found.widest_mm) + " um fits between them");
    }
    if (found.our_count != found.their_count) {
        ++totals.counts_differ;
        report(layer, distance_mm,
               std::to_string(found.our_count) + " contours, the library has " +
                   std::to_string(found.their_count));
    }
}

// Whether anything is left.
bool measure(const PartLayer& layer, double distance_mm, const Arguments& arguments,
             Totals& totals) {
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
    return !result.contours.empty();
}

void measure(const PartLayer& layer, const Arguments& arguments, Totals& totals) {
    ++totals.layers;
    totals.crossed += layer.crossed;
    for (const Contour& contour : layer.region) {
        totals.segments += count(contour).lines + count(contour).arcs;
    }
    for (const double distance_mm : arguments.distances_mm) {
        measure(layer, distance_mm, arguments, totals);
    }
    if (arguments.walls_mm <= 0) return;
    double inwards_mm = arguments.walls_mm / 2;
    while (measure(layer, -inwards_mm, arguments, totals)) inwards_mm += arguments.walls_mm;
}

void print(const Totals& totals) {
    const auto n = [](std::size_t value) { return std::to_string(value); };
    const double offsets = static_cast<double>(totals.offsets);
    bench::print(Table{
        "Offsets of layers",
        {"what", "figure"},
        {{"files (and that cannot be read)",
          n(totals.files.read) + " (" + n(totals.files.unread) + ")"},
         {"layers, with segments", n(totals.layers) + ", " + n(totals.segments)},
         {"of them, sections that cross themselves", n(totals.crossed)},
         {"offsets", n(totals.offsets)},
         {"by the second method", n(totals.second_method)},
         {"unresolved", n(totals.unresolved)},
         {"slivers left out", n(totals.slivers)},
         {"compared with finer chords", n(totals.finer)},
         {"differ from the library's", n(totals.differ)},
         {"numbers of contours differ", n(totals.counts_differ)},
         {"greatest disc that fits between them (radius)", number(1000 * totals.worst_mm) + " um"},
         {"greatest difference of areas, over the length",
          number(1000 * totals.worst_area_mm) + " um"},
         {"an offset", duration(totals.ours_s / offsets)},
         {"the longest", duration(totals.longest_s)},
         {"an offset, the library", duration(totals.polygons_s / offsets)}}});
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Offsets of layers beside those of a polygon library");
    add_options(app, arguments.parts);
    app.add_option("--distances", arguments.distances_mm, "in mm, positive: outwards");
    app.add_option("--allowed", arguments.allowed_mm, "in mm");
    app.add_option("--walls", arguments.walls_mm,
                   "besides, from half this width inwards in steps of it until nothing is left");
    app.add_flag("!--no-polygons", arguments.polygons, "ours only");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    totals.files =
        for_parts(arguments.parts.files, [&](const std::string& name, const Model& model) {
            for (const PartLayer& layer : layers_of(name, model, arguments.parts))
                measure(layer, arguments, totals);
        });
    print(totals);
    return totals.unresolved + totals.differ == 0 ? 0 : 1;
}
