// The contract in kernel/geometry/taylor.h, by its numbers, against derivatives that are known.

#include "kernel/geometry/taylor.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

using namespace lyr;
using std::numbers::pi;

namespace {

double factorial(std::size_t n) {
    return n == 0 ? 1 : static_cast<double>(n) * factorial(n - 1);
}

// The k-th derivative of (1 + t)^p.
double power_derivative(double p, double t, std::size_t k) {
    double factor = 1;
    for (std::size_t i = 0; i < k; ++i) factor *= p - static_cast<double>(i);
    return factor * std::pow(1 + t, p - static_cast<double>(k));
}

double sine_derivative(double t, std::size_t k) {
    return std::sin(t + static_cast<double>(k) * pi / 2);
}

struct Known {
    std::string name;
    std::function<Series(const Series&)> function;
    std::function<double(double, std::size_t)> derivative;
};

const std::vector<Known> known{
    {"sin", [](const Series& t) { return sin(t); }, sine_derivative},
    {"cos", [](const Series& t) { return cos(t); },
     [](double t, std::size_t k) { return sine_derivative(t, k + 1); }},
    {"sin cos", [](const Series& t) { return sin(t) * cos(t) + sin(t) * cos(t); },
     [](double t, std::size_t k) { return std::ldexp(sine_derivative(2 * t, k), int(k)); }},
    {"sinh", [](const Series& t) { return sinh(t); },
     [](double t, std::size_t k) { return k % 2 == 0 ? std::sinh(t) : std::cosh(t); }},
    {"cosh", [](const Series& t) { return cosh(t); },
     [](double t, std::size_t k) { return k % 2 == 0 ? std::cosh(t) : std::sinh(t); }},
    {"1 / (1 + t)", [](const Series& t) { return Series(1) / (Series(1) + t); },
     [](double t, std::size_t k) { return power_derivative(-1, t, k); }},
    {"sqrt(1 + t)", [](const Series& t) { return sqrt(t - Series(-1)); },
     [](double t, std::size_t k) { return power_derivative(0.5, t, k); }},
};

}  // namespace

TEST_CASE("1: coefficients hold every derivative on the interval, and not much more") {
    for (const Known& k : known) {
        CAPTURE(k.name);
        for (const double low : {0.1, 0.9, 3.0, 6.2}) {
            for (const double width : {0.0, 1e-3, 0.1, 0.8}) {
                const Series f = k.function(Series::variable(low, low + width));
                for (std::size_t n = 0; n <= Series::order; ++n) {
                    CAPTURE(n);
                    const Interval& c = f.coefficient(n);
                    const double slack = 1e-12 * (1 + c.magnitude());
                    for (int i = 0; i <= 20; ++i) {
                        const double exact = k.derivative(low + width * i / 20, n) / factorial(n);
                        CHECK(exact >= c.low - slack);
                        CHECK(exact <= c.high + slack);
                    }
                    if (width <= 1e-3)
                        CHECK(c.high - c.low <= slack + 100 * width * (1 + c.magnitude()));
                }
            }
        }
    }
}

TEST_CASE("2: what is not defined on the whole interval is unbounded") {
    const Series t = Series::variable(-0.5, 1);
    CHECK(std::isinf((Series(1) / t).coefficient(Series::order).magnitude()));
    CHECK(std::isinf(sqrt(t).coefficient(Series::order).magnitude()));
    const Series length = sqrt(t * t);
    CHECK(std::isinf((t / length).coefficient(Series::order).magnitude()));
    CHECK(std::isinf((sin(t / length) - cos(t / length)).coefficient(Series::order).magnitude()));
}
