// Functions of time by powers of it: each coefficient is a derivative by its factorial.
//
// Contract
//  1. A product, and a root of what is positive, has as many powers as its factors.
//  2. Of Sizes, which bound the sizes of the coefficients over some time, product() bounds those of the product, and
//     sizes_of_root() those of a root that is not below `least`.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace lyr::motion {

template <std::size_t count>
using Powers = std::array<double, count>;

// Taylor's about some instant.
using Series = Powers<6>;
// One more, which bounds what the series leaves out: that times the sixth power of the time since the instant.
using Sizes = Powers<7>;

template <std::size_t count>
Powers<count> product(const Powers<count>& a, const Powers<count>& b) {
    Powers<count> c{};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k + i < count; ++k) c[i + k] += a[i] * b[k];
    return c;
}

template <std::size_t count>
void add(Powers<count>& to, const Powers<count>& more) {
    for (std::size_t i = 0; i < count; ++i) to[i] += more[i];
}

template <std::size_t count>
Powers<count> plus(Powers<count> a, double constant) {
    a[0] += constant;
    return a;
}

// From g g = q, power by power.
inline Series root(const Series& square) {
    Series g{std::sqrt(square[0])};
    const double per_g = 1 / (2 * g[0]);
    for (std::size_t i = 1; i < g.size(); ++i) {
        double rest = square[i];
        for (std::size_t k = 1; k < i; ++k) rest -= g[k] * g[i - k];
        g[i] = rest * per_g;
    }
    return g;
}

// Without the root itself.
inline Sizes sizes_of_root(const Sizes& square, double least) {
    Sizes g{};
    for (std::size_t i = 1; i < g.size(); ++i) {
        double rest = square[i];
        for (std::size_t k = 1; k < i; ++k) rest += g[k] * g[i - k];
        g[i] = rest / (2 * least);
    }
    return g;
}

}  // namespace lyr::motion
