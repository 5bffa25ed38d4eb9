// Hexagons from strands that go there and back between two lines: on every third side of a hexagon two of them lie side
// by side, so that all of it is printed without a stop. From layer to layer the pattern turns about the middle of a
// hexagon by a sixth of a turn, and every wall has its turn of being double.
//
// With D the distance between opposite sides' middle lines (half a hexagon), strands lie between y = s/2 and D - s/2,
// their slopes on the hexagons' sides. A period of 2 sqrt(3) D has slopes of (D - s) / sqrt(3) and levels: in all
//     2 (D - s) / sqrt(3) + 2 sqrt(3) D,
// so that s times that is the density's share of 2 sqrt(3) D^2: 3 density D^2 - 4 s D + s^2 = 0.

#include <cmath>
#include <numbers>

#include "kernel/toolpath/infill_waves.h"

namespace lyr {

WavePattern honeycomb_waves(const InfillRequest& request) {
    constexpr double root3 = std::numbers::sqrt3;
    const double s = line_spacing_mm(request.width_mm, request.height_mm),
                 density = request.density;
    const double d = s * (2 + std::sqrt(4 - 3 * density)) / (3 * density);
    const double side = 2 * d / root3;
    const double high = d - s / 2, low = s / 2;
    // Of the hexagon about the origin the side from (side / 2, d) to (side, 0), where it is as high as that.
    const double high_x = side - high / root3, low_x = side - low / root3;
    const auto wave = [&](const auto& height) {
        return Wave{{-high_x, height(high)},
                    {{{high_x, height(high)}},
                     {{low_x, height(low)}},
                     {{3 * side - low_x, height(low)}},
                     {{3 * side - high_x, height(high)}}}};
    };
    return {.angle_rad =
                request.angle_rad + static_cast<double>(request.layer % 3) * std::numbers::pi / 3,
            .period_mm = 3 * side,
            .distance_mm = 2 * d,
            .spacing_mm = d,
            .waves = {wave([](double y) { return y; }), wave([&](double y) { return 2 * d - y; })}};
}

}  // namespace lyr
