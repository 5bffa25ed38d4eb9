// The direction of (x, y) as an angle in (-pi, pi]: half open, so that one direction has one value. atan2 alone
// returns -pi as well, for a y that is negative and vanishes.

#pragma once

#include <cmath>
#include <numbers>

namespace lyr {

inline double direction_angle(double y, double x) {
    const double value = std::atan2(y, x);
    return value <= -std::numbers::pi ? std::numbers::pi : value;
}

}  // namespace lyr
