// target/motion/series.h and smooth.h, by number: random functions, their derivatives against the bounds, and what series
// leave out.

#include "target/motion/smooth.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace lyr::motion {
namespace {

constexpr double rounding = 1e-13;

class Random {
public:
    double even(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(engine_);
    }
    // Of any size, both signs, or 0 now and then.
    double any(double least, double most) {
        if (engine_() % 5 == 0) return 0;
        const double size = std::exp(even(std::log(least), std::log(most)));
        return engine_() % 2 ? size : -size;
    }

private:
    std::mt19937 engine_{11};
};

double value_of(const Series& c, double t) {
    double value = 0;
    for (std::size_t i = c.size(); i-- > 0;) value = c[i] + t * value;
    return value;
}

struct Case {
    Smooth smooth;
    double duration_s;
};

// Turns of angles that only rise, by no more than largest_turn_rad, and a cubic.
Case any_case(Random& random) {
    Case result{{}, std::exp(random.even(std::log(1e-4), std::log(0.1)))};
    const double d = result.duration_s;
    result.smooth.clear();
    result.smooth.add_cubic(random.any(1, 1e4), random.any(1, 1e5), random.any(1, 1e6),
                            random.any(1, 1e7));
    for (int turns = static_cast<int>(random.even(0, 6.99)); turns > 0; --turns) {
        const double rate = random.even(0, 0.3) / d;
        const double half_acceleration = random.even(-rate / d / 4, 0.2 / (d * d));
        const double sixth_jerk = random.even(0, 0.2 / (d * d * d));
        result.smooth.add_turn({{rate, half_acceleration, sixth_jerk},
                                random.any(1e-2, 1e5),
                                random.any(1e-2, 1e5)});
    }
    return result;
}

}  // namespace

TEST_CASE("series 1: the root of a square is what was squared, and a product is that of its values") {
    Random random;
    for (int i = 0; i < 500; ++i) {
        Series g{random.even(1, 300)}, h{random.even(-300, 300)};
        for (std::size_t k = 1; k < g.size(); ++k) {
            g[k] = random.any(1e-3, 100);
            h[k] = random.any(1e-3, 100);
        }
        const Series found = root(product(g, g));
        for (std::size_t k = 0; k < g.size(); ++k)
            CHECK(std::abs(found[k] - g[k]) <= 1e-7 * (1 + std::abs(g[k])));
        // What has higher powers than these is below 36 times 1e4 times the sixth power.
        const double t = random.even(-1e-4, 1e-4);
        CHECK(std::abs(value_of(product(g, h), t) - value_of(g, t) * value_of(h, t)) < 1e-8);
    }
}

TEST_CASE("series 2: sizes of products and roots bound those of all functions within the sizes") {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        Sizes sizes{};
        Series g{};
        for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = std::abs(random.any(1e-3, 10));
        for (std::size_t k = 0; k < g.size(); ++k) g[k] = sizes[k] * random.even(-1, 1);
        const double least = random.even(0.5, 20);
        Series square = product(g, g);
        square[0] = least * least * random.even(1, 3);
        const Series found = root(square);
        const Sizes most = sizes_of_root(product(sizes, sizes), least);
        const Sizes squares = product(sizes, sizes);
        for (std::size_t k = 1; k < g.size(); ++k) {
            CHECK(std::abs(square[k]) <= squares[k] * (1 + rounding));
            CHECK(std::abs(found[k]) <= most[k] * (1 + rounding));
        }
    }
}

TEST_CASE("smooth 3: no derivative goes beyond the bounds, at any time of the piece") {
    Random random;
    for (int i = 0; i < 2000; ++i) {
        const auto [smooth, duration_s] = any_case(random);
        const Bounds bounds = smooth.bounds(duration_s);
        for (int look = 0; look <= 10; ++look) {
            const Series c = smooth.series(duration_s * look / 10);
            for (std::size_t k = 1; k < c.size(); ++k)
                CHECK(std::abs(c[k]) <= bounds.sizes[k] * (1 + rounding));
            CHECK(6 * c[3] <= bounds.most_jerk + rounding * 6 * bounds.sizes[3]);
            CHECK(6 * c[3] >= bounds.least_jerk - rounding * 6 * bounds.sizes[3]);
        }
    }
}

TEST_CASE("smooth 4: a series leaves out what its sixth power may, and no more") {
    Random random;
    double most_share = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto [smooth, duration_s] = any_case(random);
        const double left_out = smooth.bounds(duration_s).sizes[6];
        const double from_s = random.even(0, duration_s);
        const Series c = smooth.series(from_s);
        CHECK(c[0] == smooth.at(from_s).position);
        for (int look = 0; look <= 10; ++look) {
            const double at_s = duration_s * look / 10, t = at_s - from_s;
            const double position = smooth.at(at_s).position;
            const double off = std::abs(position - value_of(c, t));
            double largest = std::abs(position);
            for (std::size_t k = 0; k < c.size(); ++k)
                largest = std::max(largest, std::abs(c[k] * std::pow(t, k)));
            const double may_be = left_out * std::pow(t, 6);
            CHECK(off <= may_be + 1e-12 * (1 + largest));
            if (may_be > 1e-6 * (1 + largest)) most_share = std::max(most_share, off / may_be);
        }
    }
    // The bound is not one that nothing comes near to.
    CHECK(most_share > 0.1);
}

}  // namespace lyr::motion
