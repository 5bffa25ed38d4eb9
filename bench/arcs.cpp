// bench_arcs: which share of what is curved in real parts is printed as arcs, and whether the walls of cylinders are
// concentric (bench/arc_share.h).

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/arc_share.h"
#include "bench/part_layers.h"
#include "bench/scratch_file.h"
#include "bench/table.h"
#include "slicer/bounds.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

struct Arguments {
    PartLayers parts{.layers = 40};
    double largest_mm = 500;
    bool freeform = false, each = false;
};

constexpr double wanted_share = 0.95;
constexpr double mm_per_m = 1e3;

struct Totals {
    FileCount files{};
    std::size_t printed = 0, freeform = 0, large = 0, not_printed = 0, straight = 0, below = 0;
    ArcShares shares;
};

void add(const ArcShares& shares, ArcShares& sum) {
    sum.layers += shares.layers;
    sum.outlines += shares.outlines;
    sum.walls += shares.walls;
    sum.flat_mm += shares.flat_mm;
    sum.cylinders += shares.cylinders;
    sum.worst_off_quanta = std::max(sum.worst_off_quanta, shares.worst_off_quanta);
    sum.worst_centre_quanta = std::max(sum.worst_centre_quanta, shares.worst_centre_quanta);
}

std::string decimals(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

std::vector<std::string> row(const std::string& name, const ArcShares& shares) {
    return {name,
            std::to_string(shares.layers),
            number(shares.outlines.all_mm / mm_per_m),
            decimals(100 * shares.outlines.value()),
            number(shares.walls.all_mm / mm_per_m),
            decimals(100 * shares.walls.value()),
            number(shares.flat_mm / mm_per_m),
            number(shares.cylinders.all_mm / mm_per_m),
            decimals(100 * shares.cylinders.value()),
            decimals(shares.worst_off_quanta),
            decimals(shares.worst_centre_quanta)};
}

Result<ArcShares> measured(const Model& model, const Arguments& arguments) {
    slicer::Options options;
    options.threads = 1;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm =
        arguments.parts.layer_height_mm;
    const auto lyr = ScratchFile::with("");
    if (!lyr) return lyr.error();
    Diagnostics found;
    const auto printed = slicer::print(
        model, "part", lyr->path(), "", options, [](const char*, std::size_t, std::size_t) {},
        found);
    if (!printed) return printed.error();
    return arc_shares(model, lyr->path(), options, arguments.parts.layers);
}

void measure(const std::string& name, const Model& model, const Arguments& arguments, Table& table,
             Totals& totals) {
    const slicer::Options options;
    if (!is_elementary(model) && !arguments.freeform) {
        ++totals.freeform;
        return;
    }
    if (slicer::bounding_box(model, options.tolerance()).sizes().maxCoeff() >
        arguments.largest_mm) {
        ++totals.large;
        return;
    }
    const auto shares = measured(model, arguments);
    if (!shares) {
        std::printf("not printed: %s: %s\n", name.c_str(), shares.error().message.c_str());
        ++totals.not_printed;
        return;
    }
    ++totals.printed;
    if (!(shares->walls.all_mm > 0)) {
        ++totals.straight;
        return;
    }
    const bool is_below =
        shares->walls.value() < wanted_share || shares->cylinders.value() < wanted_share;
    totals.below += is_below;
    if (is_below || arguments.each) table.rows.push_back(row(name, *shares));
    add(*shares, totals.shares);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Arcs: their share of what is curved, in printed files");
    add_options(app, arguments.parts);
    app.add_option("--largest", arguments.largest_mm, "parts that are larger are left out, in mm");
    app.add_flag("--freeform", arguments.freeform, "parts with free-form faces too");
    app.add_flag("--each", arguments.each, "a row for each file, not only for those below 95 %");
    CLI11_PARSE(app, argc, argv);

    Totals totals;
    Table table{"Arcs of what is curved, and concentric walls of cylinders",
                {"file", "layers", "outlines m", "arcs %", "walls m", "arcs %", "flat m",
                 "on cylinders m", "concentric %", "off quanta", "centre off"},
                {}};
    totals.files =
        for_parts(arguments.parts.files, [&](const std::string& name, const Model& model) {
            measure(name, model, arguments, table, totals);
        });
    table.rows.push_back(row("all", totals.shares));
    print(table);
    std::printf(
        "%zu files printed, %zu of them straight throughout, %zu below 95 %%\n"
        "left out: %zu with free-form faces, %zu too large, %zu not printed\n",
        totals.printed, totals.straight, totals.below, totals.freeform, totals.large,
        totals.not_printed + totals.files.unread);
    return print({{"walls: arcs of what is curved", 100 * totals.shares.walls.value(), 95, false,
                   "%"},
                  {"walls on cylinders: concentric", 100 * totals.shares.cylinders.value(), 95,
                   false, "%"}})
               ? 0
               : 1;
}
