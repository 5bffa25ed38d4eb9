#include "bench/part_layers.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "bench/step_files.h"
#include "slicer/layers.h"

namespace lyr::bench {
namespace {

using Which = PartLayers::Which;

const char* which_text(Which which) {
    switch (which) {
        case Which::evenly_spread:
            return "at most so many of a part, evenly spread";
        case Which::from_bottom:
            return "at most so many of a part, from the bottom";
        case Which::thicker_ones:
            break;
    }
    return "at most so many of a part: it is cut into thicker ones else";
}

}  // namespace

void add_options(CLI::App& app, PartLayers& asked) {
    app.add_option("--files", asked.files, "a STEP file or a folder of them");
    app.add_option("--layer-height", asked.layer_height_mm, "in mm");
    app.add_option("--layers", asked.layers, which_text(asked.which));
}

FileCount for_parts(const std::string& files,
                    const std::function<void(const std::string&, const Model&)>& take) {
    FileCount count;
    for (const std::string& path : step_files(files)) {
        const std::string name = std::filesystem::path(path).filename();
        Diagnostics found;
        const auto model = slicer::load(path, slicer::Options{}, found);
        ++(model ? count.read : count.unread);
        if (model)
            take(name, *model);
        else
            std::printf("not read: %s: %s\n", name.c_str(), model.error().message.c_str());
        std::fflush(stdout);
    }
    return count;
}

std::vector<PartLayer> layers_of(const std::string& part, const Model& model,
                                 const PartLayers& asked) {
    const Tolerance tolerance = slicer::Options{}.tolerance();
    const Cutter cutter(model, tolerance);
    const HeightRange range = cutter.height_range();
    const double height_mm = range.top_mm - range.bottom_mm;
    const double thickness_mm =
        asked.which == Which::thicker_ones
            ? std::max(asked.layer_height_mm, height_mm / static_cast<double>(asked.layers))
            : asked.layer_height_mm;
    const std::vector<double> heights = slicer::layer_middles(height_mm, thickness_mm);
    const std::size_t taken = std::min(heights.size(), asked.layers);
    std::vector<PartLayer> layers;
    for (std::size_t i = 0; i < taken; ++i) {
        const std::size_t index =
            asked.which == Which::evenly_spread ? (2 * i + 1) * heights.size() / (2 * taken) : i;
        const Section section = cutter.cut(range.bottom_mm + heights[index]);
        RegionResult region =
            cleaned(slicer::region_of(section, tolerance).contours, tolerance.unite_mm());
        if (region.contours.empty()) continue;
        layers.push_back({part, index, heights[index], std::move(region.contours), region.changed});
    }
    return layers;
}

}  // namespace lyr::bench
