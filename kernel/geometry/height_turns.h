// From points along a stretch, in order, to those at which the height really turns.

#pragma once

#include <vector>

namespace lyr {

struct HeightSample {
    double t, z_mm;
};

// The parameters of the samples at which z turns by more than resolution_mm, first and last excluded. Every
// extremum of the stretch has to be among the samples; more than those may be.
std::vector<double> height_turns(const std::vector<HeightSample>& samples);

}  // namespace lyr
