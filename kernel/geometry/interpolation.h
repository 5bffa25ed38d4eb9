// Polynomials through points of a function at the Chebyshev-Lobatto nodes, which include both ends: neighbouring pieces
// share their border.
//
// Contract
//  1. The polynomial p of degree n through a function's values at nodes(n) is off by
//         |f - p| <= node_product(n) * max |f^(n+1)| / (n+1)!      (on [0, 1]; Cauchy's remainder)
//  2. bernstein_from_values(n) takes the values to the Bernstein coefficients of p, those at the ends to the last bit.

#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr::interpolation {

// Half the step, with an error that falls by 2^8. Higher degrees need fewer pieces, but what works on the pieces
// (products of several of them, subdivision) grows with their square.
inline constexpr int degree = 7;

inline std::vector<double> nodes(int n) {
    std::vector<double> t;
    for (int i = 0; i <= n; ++i) t.push_back(0.5 - 0.5 * std::cos(i * std::numbers::pi / n));
    return t;
}

// The largest product of distances to the nodes: on [-1, 1] it is sin(x) sin(n x) / 2^(n - 1), x the arc cosine.
inline double node_product(int n) {
    return std::ldexp(1.0, -2 * n);
}

inline Eigen::MatrixXd bernstein_from_values(int n) {
    Eigen::MatrixXd values(n + 1, n + 1);
    const std::vector<double> t = nodes(n);
    for (int i = 0; i <= n; ++i) {
        double binomial = 1;
        for (int j = 0; j <= n; ++j) {
            const double at = t[static_cast<std::size_t>(i)];
            values(i, j) = binomial * std::pow(at, j) * std::pow(1 - at, n - j);
            binomial *= static_cast<double>(n - j) / (j + 1);
        }
    }
    Eigen::MatrixXd inverse = values.inverse();
    inverse.row(0).setUnit(0);
    inverse.row(n).setUnit(n);
    return inverse;
}

}  // namespace lyr::interpolation
