// Conversions that hold everywhere.

#pragma once

#include <numbers>

namespace lyr {

inline constexpr double ns_per_s = 1e9, ns_per_ms = 1e6, ns_per_us = 1e3;
inline constexpr double nm_per_mm = 1e6, um_per_mm = 1e3;
inline constexpr double full_turn_rad = 2 * std::numbers::pi;

}  // namespace lyr
