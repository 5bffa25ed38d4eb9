// Polynomials in two parameters in Bernstein form on the unit square, and vectors of them.
//
// Contract
//  1. The values on the square lie between the smallest and the largest coefficient; those at the corners are the
//     corners' coefficients.
//  2. Products, derivatives, parts and quotients are exact save for round-off.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lyr::bernstein {

struct Tensor {
    std::size_t degree_u, degree_v;
    std::vector<double> coefficients;  // that of (i, j) at [i * (degree_v + 1) + j]

    double& at(std::size_t i, std::size_t j) { return coefficients[i * (degree_v + 1) + j]; }
    double at(std::size_t i, std::size_t j) const { return coefficients[i * (degree_v + 1) + j]; }
};
using Tensor3 = std::array<Tensor, 3>;

// The same coefficient everywhere. Times one, a polynomial is raised by the degrees.
Tensor constant(double value, std::size_t degree_u, std::size_t degree_v);

Tensor product(const Tensor& a, const Tensor& b);
Tensor3 product(const Tensor& a, const Tensor3& b);
// a + factor * b, of the same degrees.
Tensor sum(Tensor a, const Tensor& b, double factor = 1);
Tensor3 sum(Tensor3 a, const Tensor3& b, double factor = 1);
Tensor dot(const Tensor3& a, const Tensor3& b);
Tensor3 cross(const Tensor3& a, const Tensor3& b);

// Along u (0) or v (1); of a constant along it, zero.
Tensor derivative(const Tensor& a, int along);
Tensor3 derivative(const Tensor3& a, int along);

double evaluate(const Tensor& a, double u, double v);

// The polynomial on [from, to] of one parameter, stretched to the square.
Tensor part(const Tensor& a, int along, double from, double to);

struct Bounds {
    double low, high;
    double magnitude() const { return high > -low ? high : -low; }
};
Bounds bounds(const Tensor& a);

// The sides of the square: a parameter is zero there or one.
struct Side {
    int along;
    bool at_end;
};
inline constexpr std::array<Side, 4> sides{Side{0, false}, {0, true}, {1, false}, {1, true}};

double largest_on(const Tensor& a, const Side& side);

// Divided by the distance from a side on which the polynomial is zero; what its coefficients there are is not looked
// at.
Tensor divided_by_distance(const Tensor& a, const Side& side);

}  // namespace lyr::bernstein
