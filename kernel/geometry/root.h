// A root between two bounds: Newton's method kept inside a bracket that bisection shrinks.
//
// Contract
//  1. f(t) gives {value, derivative}; the value has one sign change between `from` and `to`. The sign at `from`
//     is passed, not computed, so that a caller can exclude a root that lies on the bound itself.
//  2. The result lies between the bounds; there |value| <= value_tolerance, or the bracket cannot shrink.
//  3. The derivative only guides: it may be wrong or zero. The number of steps is bounded.

#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace lyr {

template <class Function>
double bracketed_root(const Function& f, double from, double to, bool positive_at_from,
                      double first_guess, double value_tolerance) {
    // Two thirds of the steps may be wasted by Newton and the bracket still shrinks to neighbours: a double
    // has 52 bits of mantissa, a bracket around zero a few dozen more of interest.
    constexpr int max_steps = 200;
    double low = from, high = to;  // the sign of `from` holds at low
    double t = first_guess;
    if (!(t > std::min(from, to) && t < std::max(from, to))) t = 0.5 * (from + to);
    double step = high - low, step_before = step;
    for (int i = 0; i < max_steps; ++i) {
        const auto [value, slope] = f(t);
        if (std::abs(value) <= value_tolerance) return t;
        if ((value > 0) == positive_at_from) {
            low = t;
        } else {
            high = t;
        }
        const double newton = t - value / slope;
        const bool inside = newton > std::min(low, high) && newton < std::max(low, high);
        const bool converges = std::abs(2 * value) <= std::abs(step_before * slope);
        const double next = inside && converges ? newton : 0.5 * (low + high);
        step_before = step;
        step = next - t;
        if (next == t || next == low || next == high) return next;
        t = next;
    }
    return t;
}

}  // namespace lyr
