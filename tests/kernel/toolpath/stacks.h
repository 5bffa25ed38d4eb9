// Outlines of layers over each other, for tests of skins.

#pragma once

#include <cmath>
#include <vector>

#include "kernel/region/regions.h"

namespace lyr::testing {

inline const std::vector<Motion> motions{
    {}, {0.4, {3, -7}}, {pi / 2, {0, 1}}, {1.1, {-20, 5}, true}};

// Ten layers of a plate, ten of its half.
inline std::vector<Contours> staircase() {
    std::vector<Contours> layers(10, {rectangle(0, 0, 20, 10)});
    layers.insert(layers.end(), 10, {rectangle(0, 0, 10, 10)});
    return layers;
}

// A lens: it widens to the middle and closes again.
inline std::vector<Contours> lens() {
    std::vector<Contours> layers;
    for (int i = 0; i < 24; ++i) {
        const double z = (i + 0.5) / 12 - 1;
        layers.push_back({FullCircle{{1, 2}, 12 * std::sqrt(1 - z * z), true}});
    }
    return layers;
}

// A box with a cavity from layer 6 to layer 14.
inline std::vector<Contours> hollow_box() {
    std::vector<Contours> layers(20, {rectangle(0, 0, 30, 20)});
    for (std::size_t i = 6; i < 14; ++i) layers[i].push_back(reversed(rectangle(8, 5, 22, 15)));
    return layers;
}

}  // namespace lyr::testing
