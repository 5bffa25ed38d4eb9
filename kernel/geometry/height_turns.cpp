// Hysteresis: a turn is believed once the height has come back from it by more than the resolution. What is
// smaller is the noise of a constant stretch, of round-off in the file, or of an end that is itself the extremum.

#include "kernel/geometry/height_turns.h"

#include "kernel/geometry/tolerance.h"

namespace lyr {

std::vector<double> height_turns(const std::vector<HeightSample>& samples) {
    std::vector<double> turns;
    if (samples.empty()) return turns;
    HeightSample low = samples.front(), high = samples.front();
    int direction = 0;  // +1 while rising, -1 while falling, 0 while neither is certain
    for (const HeightSample& sample : samples) {
        if (sample.z_mm > high.z_mm) high = sample;
        if (sample.z_mm < low.z_mm) low = sample;
        if (direction <= 0 && sample.z_mm - low.z_mm > resolution_mm) {
            if (direction < 0) turns.push_back(low.t);
            direction = 1;
            high = sample;
        } else if (direction >= 0 && high.z_mm - sample.z_mm > resolution_mm) {
            if (direction > 0) turns.push_back(high.t);
            direction = -1;
            low = sample;
        }
    }
    return turns;
}

}  // namespace lyr
