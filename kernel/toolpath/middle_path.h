// A stretch of a region's middle line as few lines and arcs, and the width along it.
//
// Contract: no point of the middle line is farther than `allowed_mm` from the path, and no part of the path is much longer
// than what it stands for. Widths are those of the discs,
// but no more than the greatest that is asked for.

#pragma once

#include <vector>

#include "kernel/toolpath/medial_chains.h"
#include "kernel/toolpath/strand.h"

namespace lyr {

// A place along a chain.
struct Station {
    MedialPoint point;
    double at_mm;
    double area_mm2;  // of the region, from the chain's start
};

// A chain's edges, each with its stations.
using Stations = std::vector<std::vector<Station>>;

Stations stations_of(const MedialChain& chain);
// What lies between two places.
Stations part(const Stations& stations, double from_mm, double to_mm);

struct WidthLimits {
    double greatest_mm, step_mm;
};

Strand strand_along(const Stations& stations, bool is_closed, const WidthLimits& limits,
                    double allowed_mm);

}  // namespace lyr
