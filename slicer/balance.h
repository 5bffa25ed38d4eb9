// Whether what is laid down of a layer is what its section asks for. Nothing here knows how walls and fill are made.
//
// Contract
//  1. What is to be solid is the section without sparse fill and without what is told as too thin (left_out.h). Against it
//     stand the strands of walls and solid fill: their lengths, times their widths without what flanks of neighbours share,
//     times the flow that their fill gave them. Support, and the flow of the filament and of bridges, are no part of it.
//  2. A square is as wide as a wall's line. Too little is what lacks more than 5 squares, or a tenth of what is to be solid if
//     that is less, and 0.5 % of it, or 6 um along the outline if that is less; too much is more than a tenth. Less than a
//     square is neither.
//  3. Without gap fill nothing is too little: so it is wished.
//  4. Each run of layers that lack something, or have too much, is one warning, with the layer and the place where it is
//     worst; after a few runs the others are counted.
//
// Cost: the sums. The place is only looked for where there is something to be said.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slicer/fill.h"

namespace lyr::slicer {

struct Imbalance {
    enum class Kind : std::uint8_t { too_little, too_much };
    Kind kind = Kind::too_little;
    double off_mm2 = 0, solid_mm2 = 0;  // what is to be solid
    Point2 at = Point2::Zero();
};
std::optional<Imbalance> imbalance_of(const OutlinedLayer& layer, const LayerFill& fill,
                                      const LayerSpan& span, const profile::Profile& profile);

class BalanceReport {
public:
    // In the order of the layers.
    void add(const std::optional<Imbalance>& found, std::size_t index);
    // Once all are added.
    void finish(std::span<const LayerSpan> spans, Diagnostics& diagnostics) const;

private:
    struct Run {
        std::size_t first = 0, last = 0, worst_layer = 0;
        Imbalance worst{};
    };
    std::vector<Run> runs_{};
};

}  // namespace lyr::slicer
