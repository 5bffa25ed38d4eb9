// Taylor coefficients of a function on a whole interval at once: what the error of an interpolation is bounded by.
//
// Contract
//  1. Series::coefficient(k) holds f^(k)(t) / k! for every t of the interval that variable() was made for, f being what
//     has been computed from it; to round-off, which the remainders bounded here are far above.
//  2. Where an operation is not defined on the whole interval (division by what may be zero), coefficients are
//     unbounded.
//
// Functions are written once, as templates, and called with numbers for values and with Series for bounds.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "kernel/geometry/interpolation.h"

namespace lyr {

struct Interval {
    double low = 0, high = 0;

    static Interval everything() { return {-INFINITY, INFINITY}; }
    double magnitude() const { return std::fmax(-low, high); }
    bool is_positive() const { return low > 0; }
};

Interval operator+(const Interval& a, const Interval& b);
Interval operator-(const Interval& a, const Interval& b);
Interval operator*(const Interval& a, const Interval& b);

class Series {
public:
    static constexpr std::size_t order = interpolation::degree + 1;

    Series(double constant = 0) : c_{} { c_[0] = {constant, constant}; }

    // The function t itself, for t from `low` to `high`.
    static Series variable(double low, double high);

    const Interval& coefficient(std::size_t k) const { return c_[k]; }

    Series& operator+=(const Series& other);
    Series& operator-=(const Series& other);

    friend Series operator*(const Series& a, const Series& b);
    friend Series operator/(const Series& a, const Series& b);
    friend Series sqrt(const Series& a);
    friend Series sin(const Series& a);
    friend Series cos(const Series& a);
    friend Series sinh(const Series& a);
    friend Series cosh(const Series& a);

private:
    struct Pair;
    static Pair sine_and_cosine(const Series& a);
    static Pair hyperbolic(const Series& a);

    std::array<Interval, order + 1> c_;
};

inline Series operator+(Series a, const Series& b) {
    return a += b;
}
inline Series operator-(Series a, const Series& b) {
    return a -= b;
}

}  // namespace lyr
