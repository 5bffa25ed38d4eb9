// A part of as many faces as one likes, of which every plane meets eight: a rounded square bar, its sides divided into
// storeys. As STEP text, because reading it is measured too.

#pragma once

#include <cstddef>
#include <string>

namespace lyr::bench {

inline constexpr double tower_half_width_mm = 10, tower_radius_mm = 3, tower_storey_mm = 0.2;

inline constexpr std::size_t tower_faces(std::size_t storeys) {
    return 8 * storeys + 2;
}

// Of every section.
double tower_area_mm2();

std::string tower_step(std::size_t storeys);

}  // namespace lyr::bench
