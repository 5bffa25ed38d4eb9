// On which of the heights where a part has level faces a layer can end.
//
// Contract
//  1. Between two landings that follow each other, and from the start to the first one, a whole number of layers of the
//     thickness allowed fits.
//  2. The highest of the heights is landed on, if any number of layers fits below it; else the last landing is as near to
//     it as layers can end, the lower one of two.
//  3. Among all such choices as many heights are landed on as can be.

#pragma once

#include <span>
#include <vector>

namespace lyr::slicer {

struct Thickness {
    double least_mm, most_mm;
};

// How many layers of the thickness allowed fill so much exactly; 0: none do. The fewest.
std::size_t fewest_layers(double height_mm, const Thickness& allowed);

// `heights_mm` rise and are above `start_mm`, which is left out of the result. Empty if no layer is nearer to the highest
// one than the start is.
std::vector<double> landings(double start_mm, std::span<const double> heights_mm,
                             const Thickness& allowed);

}  // namespace lyr::slicer
