// What stepc says of a print's size and layers.

#include <cstdio>
#include <string_view>

#include "base/text.h"
#include "slicer/raft.h"
#include "slicer/slicer.h"

namespace lyr::slicer {
namespace {

std::string uniform_text(const profile::Layer& layer) {
    char text[80];
    std::snprintf(text, sizeof text, " at %g mm a layer", layer.height_mm);
    return text;
}

std::string adaptive_text(const AdaptiveFigures& figures, const profile::Layer& layer,
                          std::size_t layers) {
    char first[40], thinnest[40], thickest[40];
    std::snprintf(first, sizeof first, " in a first layer of %.3g mm", layer.first_height_mm);
    std::snprintf(thinnest, sizeof thinnest, "%.3g", figures.thinnest_mm);
    std::snprintf(thickest, sizeof thickest, "%.3g", figures.thickest_mm);
    std::string text = first;
    if (layers == 1) return text;
    text += " and others of ";
    if (std::string_view(thickest) != thinnest) text += std::string(thinnest) + " to ";
    return text + thickest + " mm";
}

std::string steps_text(const AdaptiveFigures& figures, double cusp_mm) {
    char text[120];
    std::snprintf(text, sizeof text, "for steps of %g mm uniform layers would be %zu of %.3g mm",
                  cusp_mm, figures.uniform_layers, figures.uniform_mm);
    std::string result = text;
    if (figures.deeper_layers > 0)
        result += "; steps may be deeper in " + counted(figures.deeper_layers, "layer") +
                  " (layer.min_height)";
    return result + '\n';
}

}  // namespace

std::string size_text(const Summary& summary, const Options& options) {
    const auto size = summary.box.sizes();
    const profile::Layer& layer = options.profile.layer;
    char line[160];
    std::snprintf(line, sizeof line, "%.3f x %.3f x %.3f mm", size.x(), size.y(), size.z());
    std::string text = line;
    text += summary.adaptive
                ? adaptive_text(*summary.adaptive, part_layers(options.profile), summary.layers)
                : uniform_text(layer);
    std::snprintf(line, sizeof line, ", tolerance %g mm\n", options.tolerance().total_mm);
    text += line;
    // Of a single layer there is nothing to compare.
    if (!summary.adaptive || summary.layers == 1) return text;
    return text + steps_text(*summary.adaptive, layer.cusp_mm);
}

}  // namespace lyr::slicer
