// Gauss quadrature over stretches that knots divide.

#pragma once

#include <array>
#include <numbers>
#include <vector>

namespace lyr {

// Gauss-Legendre on [0, 1], three points: exact for polynomials of degree five.
inline constexpr std::array<double, 3> gauss_at{0.11270166537925831, 0.5, 0.88729833462074169};
inline constexpr std::array<double, 3> gauss_weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

// How many panels an edge or a line across a surface has.
struct Fineness {
    int fewest, most;
    double widest_rad;  // of a conic
};

// Fewer panels miss the bends of a high degree, more cost time and add nothing that freeform_accuracy shows.
inline constexpr Fineness for_figures{8, 32, std::numbers::pi / 8};

// For a sign alone: simple edges in fewer panels, those of many spans in as many.
inline constexpr Fineness for_signs{2, 32, std::numbers::pi / 2};

// The borders of panels from `from` to `to` (rising): distinct knots between them, thinned out to the most or with
// their spans divided until there are the fewest.
std::vector<double> panel_borders(const std::vector<double>& knots, double from, double to,
                                  const Fineness& fineness);

}  // namespace lyr
