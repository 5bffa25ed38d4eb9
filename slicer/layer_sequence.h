// Layers between two heights at which one has to end, as few as their steps allow.
//
// Contract
//  1. The layers fill what is between the two heights; none is thinner or thicker than allowed.
//  2. A layer thicker than the thinnest has steps no deeper than `depth_mm` (kernel/section/flatness.h), unless no whole
//     number of such layers fits: then the thinnest give way, all by the same factor, which is the least that does.
//  3. No sequence that holds 1 and 2 has fewer layers.
//  4. Where there is a choice, all layers but the thinnest are thinner by one factor than they might be: their steps are
//     alike and none is left over.

#pragma once

#include <vector>

#include "kernel/section/flatness.h"
#include "slicer/landings.h"

namespace lyr::slicer {

struct StepLimits {
    double depth_mm;
    Thickness thickness;
};

// Where layers end, `to_mm` last. Some number of layers has to fit (fewest_layers()).
std::vector<double> layer_tops(double from_mm, double to_mm, const FlatnessProfile& flatness,
                               const StepLimits& limits);

}  // namespace lyr::slicer
