// What of a print is so thin that no line is printed for it.
//
// Contract
//  1. Of a layer, what is left out is counted where it is more than the tip of a corner, or, however small, an island of
//     its own or a web without which parts of the layer come apart.
//  2. There is one warning for the print: in how many layers, over what heights, and where the most of it is.

#pragma once

#include <optional>
#include <span>

#include "slicer/fill.h"

namespace lyr::slicer {

struct LeftOut {
    double thin_mm2 = 0;
    std::optional<Point2>
        place{};  // of the first web that is not whole, or else the first island with nothing in it
    bool is_all = false;  // nothing is printed in the layer
};
LeftOut left_out_of(const OutlinedLayer& layer, const LayerFill& fill);

class LeftOutReport {
public:
    // In the order of the layers.
    void add(const LeftOut& layer, std::size_t index);
    // Once all are added. Errors: nothing is printed at all.
    Status finish(std::span<const OutlinedLayer> layers, std::span<const LayerSpan> spans,
                  const Options& options, Diagnostics& diagnostics) const;

private:
    std::size_t layers_ = 0, first_ = 0, last_ = 0, most_ = 0;
    LeftOut most_left_{};
    bool prints_ = false;
};

// That no layer has anything that could be printed.
Diagnostic nothing_to_print(const profile::Perimeters& perimeters);

}  // namespace lyr::slicer
