// Polynomials in Bernstein form on [0, 1]: the form in which bounds and numbers of roots can be read off.
//
// Contract
//  1. The values on [0, 1] lie between the smallest and the largest coefficient.
//  2. The number of roots inside (0, 1), with multiplicity, is at most sign_variations() and of the same parity.
//  3. isolate() finds every simple root and every group of roots that `negligible` does not wave through.

#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace lyr::bernstein {

using Coefficients = std::vector<double>;

double evaluate(const Coefficients& c, double t);
Coefficients derivative(const Coefficients& c);
Coefficients product(const Coefficients& a, const Coefficients& b);
Coefficients difference(const Coefficients& a, const Coefficients& b);
int sign_variations(const Coefficients& c);

// The coefficients on [0, t] and on [t, 1].
std::pair<Coefficients, Coefficients> split(const Coefficients& c, double t);

// The only root inside (0, 1) of a polynomial with one sign variation.
double single_root(const Coefficients& c);

// Candidates for sign changes inside (0, 1), in order: each simple root, and one point from each interval in
// which several roots may lie but which `negligible(coefficients, width)` says is of no interest.
using Negligible = std::function<bool(const Coefficients&, double width)>;
std::vector<double> isolate(const Coefficients& c, const Negligible& negligible);

}  // namespace lyr::bernstein
