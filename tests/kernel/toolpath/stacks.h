// Outlines of layers over each other, for tests of skins and bridges, and what these are asked for.

#pragma once

#include <cmath>
#include <vector>

#include "kernel/region/regions.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/skins.h"

namespace lyr::testing {

inline constexpr double walls_mm = 0.6;
inline constexpr SkinRequest usual_skins{.top_layers = 3,
                                         .bottom_layers = 2,
                                         .width_mm = width_mm,
                                         .min_sparse_mm2 = 0,
                                         .allowed_mm = allowed_mm};

// How deep a point is in the region; negative: how far from it.
inline double depth_in(const Contours& region, const Point2& point) {
    const double distance = distance_to(region, point);
    return winding(region, point) > 0 ? distance : -distance;
}

// Of directions: a half turn makes no difference.
inline double apart(double a, double b) {
    const double turn = std::abs(a - b) / pi;
    return pi * std::abs(turn - std::round(turn));
}

inline double after(double angle, const Motion& motion) {
    return motion.angle_rad + (motion.mirrored ? -angle : angle);
}

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
