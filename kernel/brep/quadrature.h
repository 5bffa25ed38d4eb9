// Gauss quadrature over stretches that knots divide.

#pragma once

#include <array>
#include <vector>

namespace lyr {

// Gauss-Legendre on [0, 1], three points: exact for polynomials of degree five.
inline constexpr std::array<double, 3> gauss_at{0.11270166537925831, 0.5, 0.88729833462074169};
inline constexpr std::array<double, 3> gauss_weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

// Fewer panels miss the bends of a high degree, more cost time and add nothing that freeform_accuracy shows.
inline constexpr int fewest_panels = 8, most_panels = 32;

// The borders of panels from `from` to `to` (rising): distinct knots between them, thinned out to most_panels or with
// their spans divided until there are fewest_panels.
std::vector<double> panel_borders(const std::vector<double>& knots, double from, double to);

}  // namespace lyr
