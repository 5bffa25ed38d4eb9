// Real parts and their layers, for benchmarks of what is done with layers.

#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "slicer/slicer.h"

namespace lyr::bench {

struct PartLayers {
    std::string files = LYR_FIXTURES "/parts";
    double layer_height_mm = 0.2;
    std::size_t layers = 20;  // of a part, at most
    enum class Which { evenly_spread, from_bottom, thicker_ones } which = Which::evenly_spread;
};

// --files, --layer-height and --layers.
void add_options(CLI::App& app, PartLayers& asked);

struct PartLayer {
    std::string part;
    std::size_t index;  // among all layers of the height
    double z_mm;        // over the part's bottom
    std::vector<Contour> region;
    bool
        crossed;  // faces of the model overlap a little: the section crossed itself, and no longer does
};

struct FileCount {
    std::size_t read = 0, unread = 0;
};

// Calls take(name, model) for each STEP file; of those that cannot be read it prints why.
FileCount for_parts(const std::string& files,
                    const std::function<void(const std::string&, const Model&)>& take);

// Layers of nothing are left out.
std::vector<PartLayer> layers_of(const std::string& part, const Model& model,
                                 const PartLayers& asked);

}  // namespace lyr::bench
