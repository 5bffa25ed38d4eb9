// Infill of curves that repeat in two directions: honeycombs and gyroids.

#pragma once

#include <vector>

#include "kernel/toolpath/infill.h"

namespace lyr {

// One period of a strand.
struct Wave {
    Point2 start;
    std::vector<Segment> segments;
};

// Every wave goes on by `period_mm` along x, and is there again every `distance_mm` along y; all turned by the angle.
struct WavePattern {
    double angle_rad = 0;
    double period_mm = 0;
    double distance_mm = 0;
    double spacing_mm = 0;  // of strands, about
    std::vector<Wave> waves{};
};

WavePattern honeycomb_waves(const InfillRequest& request);
WavePattern gyroid_waves(const InfillRequest& request);

// The pattern over the whole region, clipped and linked along the boundary.
void fill_with_waves(Region inside, const WavePattern& pattern, const InfillRequest& request,
                     Fill& fill);

}  // namespace lyr
