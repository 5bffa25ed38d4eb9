// Whether a print stays where its printer can go.
//
// Contract
//  1. All motions count, ways included: those of a layer are as far as the layer's totals say.
//  2. There is one warning for each axis, and one for a delta's reach, with the place that is farthest beyond and the first
//     layer in which it is. Of a delta's reach only the sides of the layer's box are known to be touched, not its corners:
//     it is the printer itself that looks at every curve.

#pragma once

#include <array>
#include <cstddef>

#include "base/diagnostic.h"
#include "format/writer.h"
#include "target/config/printer.h"

namespace lyr::slicer {

class RangeReport {
public:
    // Layers from 0, in any order.
    void add(const format::EncodedLayer& layer, std::size_t index, const config::Printer& printer);
    void finish(const config::Printer& printer, Diagnostics& diagnostics) const;

private:
    struct Farthest {
        double beyond_mm = 0, at_mm = 0;
        std::size_t layer = 0;
        void take(double other_beyond_mm, double other_at_mm, std::size_t other_layer);
    };

    std::array<Farthest, 3> axes_;
    Farthest from_middle_;
};

}  // namespace lyr::slicer
