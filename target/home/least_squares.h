// The few unknowns that bring many measurements closest to what they should be.
//
// Method. Gauss-Newton with differences for derivatives; each step is solved by Householder reflections of the matrix of
// derivatives, whose square is never formed, so that unknowns that are hard to tell apart cost digits only once.
//
// Contract
//  1. The unknowns returned have residuals whose sum of squares no small change makes less, if the begin was near enough;
//     none: a residual that is not a number, fewer measurements than unknowns, or unknowns that the measurements do not
//     tell apart.
//  2. `scale` are changes of the unknowns that matter about as much: derivatives are taken over a thousandth of them.

#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace lyr::home {

using Numbers = std::vector<double>;
using Residuals = std::function<Numbers(const Numbers& unknowns)>;

std::optional<Numbers> least_squares(const Residuals& residuals, Numbers begin,
                                     const Numbers& scale);

}  // namespace lyr::home
