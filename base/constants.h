// Conversions that hold everywhere.

#pragma once

#include <numbers>

namespace lyr {

inline constexpr double ns_per_s = 1e9;
inline constexpr double full_turn_rad = 2 * std::numbers::pi;

}  // namespace lyr
