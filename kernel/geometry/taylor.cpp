// The recurrences of automatic differentiation, each with intervals for numbers.

#include "kernel/geometry/taylor.h"

#include <algorithm>
#include <initializer_list>
#include <numbers>

namespace lyr {

namespace {

using std::numbers::pi;

// Infinities that cancel leave nothing known.
Interval hull(std::initializer_list<double> values) {
    Interval result{INFINITY, -INFINITY};
    for (const double value : values) {
        if (std::isnan(value)) return Interval::everything();
        result = {std::min(result.low, value), std::max(result.high, value)};
    }
    return result;
}

Interval scaled(const Interval& a, double factor) {
    return hull({factor * a.low, factor * a.high});
}

Interval inverse(const Interval& a) {
    if (a.low <= 0 && a.high >= 0) return Interval::everything();
    return {1 / a.high, 1 / a.low};
}

Interval cosine(const Interval& a) {
    if (!(a.high - a.low < 2 * pi)) return {-1, 1};
    Interval result = hull({std::cos(a.low), std::cos(a.high)});
    const auto passes = [&](double phase) {
        return std::floor((a.high - phase) / (2 * pi)) > std::floor((a.low - phase) / (2 * pi));
    };
    if (passes(0)) result.high = 1;
    if (passes(pi)) result.low = -1;
    return result;
}

Interval hyperbolic_cosine(const Interval& a) {
    Interval result = hull({std::cosh(a.low), std::cosh(a.high)});
    if (a.low <= 0 && a.high >= 0) result.low = 1;
    return result;
}

}  // namespace

Interval operator+(const Interval& a, const Interval& b) {
    return hull({a.low + b.low, a.high + b.high});
}

Interval operator-(const Interval& a, const Interval& b) {
    return hull({a.low - b.high, a.high - b.low});
}

Interval operator*(const Interval& a, const Interval& b) {
    // Nothing times what is unbounded is nothing: there is no such term.
    if ((a.low == 0 && a.high == 0) || (b.low == 0 && b.high == 0)) return {};
    return hull({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

struct Series::Pair {
    Series first, second;
};

Series Series::variable(double low, double high) {
    Series t;
    t.c_[0] = {low, high};
    t.c_[1] = {1, 1};
    return t;
}

Series& Series::operator+=(const Series& other) {
    for (std::size_t k = 0; k <= order; ++k) c_[k] = c_[k] + other.c_[k];
    return *this;
}

Series& Series::operator-=(const Series& other) {
    for (std::size_t k = 0; k <= order; ++k) c_[k] = c_[k] - other.c_[k];
    return *this;
}

Series operator*(const Series& a, const Series& b) {
    Series result;
    for (std::size_t k = 0; k <= Series::order; ++k) {
        for (std::size_t i = 0; i <= k; ++i) result.c_[k] = result.c_[k] + a.c_[i] * b.c_[k - i];
    }
    return result;
}

Series operator/(const Series& a, const Series& b) {
    Series result;
    const Interval by = inverse(b.c_[0]);
    for (std::size_t k = 0; k <= Series::order; ++k) {
        Interval rest = a.c_[k];
        for (std::size_t i = 0; i < k; ++i) rest = rest - result.c_[i] * b.c_[k - i];
        result.c_[k] = rest * by;
    }
    return result;
}

Series sqrt(const Series& a) {
    Series result;
    const Interval& square = a.c_[0];
    result.c_[0] = {std::sqrt(std::max(square.low, 0.0)), std::sqrt(std::max(square.high, 0.0))};
    const Interval by = inverse(scaled(result.c_[0], 2));
    for (std::size_t k = 1; k <= Series::order; ++k) {
        Interval rest = a.c_[k];
        for (std::size_t i = 1; i < k; ++i) rest = rest - result.c_[i] * result.c_[k - i];
        result.c_[k] = rest * by;
    }
    return result;
}

// s' = c a', c' = -s a'.
Series::Pair Series::sine_and_cosine(const Series& a) {
    Series s, c;
    c.c_[0] = cosine(a.c_[0]);
    s.c_[0] = cosine(a.c_[0] - Interval{pi / 2, pi / 2});
    for (std::size_t k = 1; k <= order; ++k) {
        Interval sine{}, cosine_sum{};
        for (std::size_t i = 1; i <= k; ++i) {
            const Interval slope = scaled(a.c_[i], static_cast<double>(i));
            sine = sine + slope * c.c_[k - i];
            cosine_sum = cosine_sum - slope * s.c_[k - i];
        }
        s.c_[k] = scaled(sine, 1 / static_cast<double>(k));
        c.c_[k] = scaled(cosine_sum, 1 / static_cast<double>(k));
    }
    return {s, c};
}

Series::Pair Series::hyperbolic(const Series& a) {
    Series s, c;
    c.c_[0] = hyperbolic_cosine(a.c_[0]);
    s.c_[0] = {std::sinh(a.c_[0].low), std::sinh(a.c_[0].high)};
    for (std::size_t k = 1; k <= order; ++k) {
        Interval sine{}, cosine_sum{};
        for (std::size_t i = 1; i <= k; ++i) {
            const Interval slope = scaled(a.c_[i], static_cast<double>(i));
            sine = sine + slope * c.c_[k - i];
            cosine_sum = cosine_sum + slope * s.c_[k - i];
        }
        s.c_[k] = scaled(sine, 1 / static_cast<double>(k));
        c.c_[k] = scaled(cosine_sum, 1 / static_cast<double>(k));
    }
    return {s, c};
}

Series sin(const Series& a) {
    return Series::sine_and_cosine(a).first;
}
Series cos(const Series& a) {
    return Series::sine_and_cosine(a).second;
}
Series sinh(const Series& a) {
    return Series::hyperbolic(a).first;
}
Series cosh(const Series& a) {
    return Series::hyperbolic(a).second;
}

}  // namespace lyr
