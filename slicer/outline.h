// The first pass over a layer: what is to be printed there, and its walls.

#pragma once

#include <optional>

#include "kernel/toolpath/skins.h"
#include "kernel/toolpath/walls.h"
#include "slicer/layers.h"

namespace lyr::slicer {

// A layer reaches from `bottom_mm` to `top_mm` over the bed and is cut in its middle.
struct LayerSpan {
    double bottom_mm, top_mm;

    double height_mm() const { return top_mm - bottom_mm; }
    double middle_mm() const { return (bottom_mm + top_mm) / 2; }
};

// The first layer has its own thickness. Layers go on as long as their middles are below the part's top.
std::vector<LayerSpan> layer_spans(double part_height_mm, const profile::Layer& layer);

// What one layer's work gives; `error` ends the print.
struct OutlinedLayer {
    std::vector<Contour> outline{};
    SkinOutline seen{};  // of the outline
    Walls walls{};
    SectionFigures section{}, printed{};
    bool united = false;
    bool uncrossed = false;  // the section crossed itself; the outline is what it winds around
    std::size_t slivers = 0;
    Diagnostics diagnostics{};
    std::optional<Diagnostic> error{};
};

// The walls of layer.outline, which is mended first where it crosses itself and they cannot be made for that.
void add_walls(OutlinedLayer& layer, const LayerSpan& span, const Options& options);

// `box`: the whole part's, on the bed. `index` counts from 0.
OutlinedLayer outline_layer(const Cutter& cutter, std::size_t index, const LayerSpan& span,
                            const Eigen::AlignedBox3d& box, const Options& options);

}  // namespace lyr::slicer
