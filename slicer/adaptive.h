// Layers as thick as the depth of their steps allows, which end on level faces (docs/algorithms/adaptive.md).
//
// Contract
//  1. Layers fill the part from the bed to its top, one on the other. The first is `layer.first_height_mm` thick, all
//     others from `layer.min_height_mm` to `layer.max_height_mm`.
//  2. No layer but the first that is thicker than the thinnest has steps deeper than `layer.cusp_mm`; where no whole
//     number of layers fits between two level faces for that, some are thicker than that. Figures say how deep they are.
//  3. A layer ends within level_rise_mm of every level face, but for those that lie too close to each other, to the bed or
//     to the first layer's top: each height left out is a warning with its faces.
//  4. Turning the part about the vertical or mirroring it changes the layers by no more than the bounds of flatness.h
//     differ; the number of threads changes nothing.

#pragma once

#include <vector>

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "slicer/outline.h"

namespace lyr::slicer {

struct LayerPlan {
    std::vector<LayerSpan> spans;
    AdaptiveFigures figures;
};

// `placed` is on the bed and `part_height_mm` high.
LayerPlan adaptive_plan(const Model& placed, double part_height_mm, const Options& options,
                        Diagnostics& diagnostics);

// The layers that the profile asks for, on a raft if there is one; `placed` as it is printed.
std::vector<LayerSpan> planned_layers(const Model& placed, const Options& options, Summary& summary,
                                      Diagnostics& diagnostics);

}  // namespace lyr::slicer
