// The contract in kernel/geometry/bernstein_tensor.h, by its numbers: operations on coefficients are those on values.

#include "kernel/geometry/bernstein_tensor.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace lyr;
using bernstein::Tensor;
using bernstein::Tensor3;

namespace {

class RandomTensors {
public:
    Tensor next(std::size_t degree_u, std::size_t degree_v) {
        Tensor t = bernstein::constant(0, degree_u, degree_v);
        for (double& c : t.coefficients) c = amount_(random_);
        return t;
    }
    Tensor3 next3(std::size_t degree_u, std::size_t degree_v) {
        return {next(degree_u, degree_v), next(degree_u, degree_v), next(degree_u, degree_v)};
    }

private:
    std::mt19937 random_{1};
    std::uniform_real_distribution<double> amount_{-1, 1};
};

constexpr double places[]{0, 0.1, 0.35, 0.5, 0.8, 1};

template <class Visit>
void for_each_place(Visit visit) {
    for (const double u : places) {
        for (const double v : places) visit(u, v);
    }
}

bool same(double a, double b) {
    return std::abs(a - b) < 1e-12;
}

}  // namespace

TEST_CASE("1: values lie between the coefficients, and at the corners are they") {
    RandomTensors random;
    const Tensor a = random.next(4, 3);
    const bernstein::Bounds all = bounds(a);
    for_each_place([&](double u, double v) {
        CHECK(evaluate(a, u, v) >= all.low);
        CHECK(evaluate(a, u, v) <= all.high);
    });
    CHECK(evaluate(a, 0, 0) == a.at(0, 0));
    CHECK(evaluate(a, 1, 0) == a.at(4, 0));
    CHECK(evaluate(a, 0, 1) == a.at(0, 3));
}

TEST_CASE("2: products, sums and vectors") {
    RandomTensors random;
    const Tensor a = random.next(2, 5), b = random.next(3, 0), c = random.next(2, 5);
    const Tensor3 p = random.next3(2, 1), q = random.next3(1, 3);
    const Tensor3 out = cross(p, q);
    for_each_place([&](double u, double v) {
        const auto value = [&](const Tensor& t) { return evaluate(t, u, v); };
        CHECK(same(value(product(a, b)), value(a) * value(b)));
        CHECK(same(value(sum(a, c, -3)), value(a) - 3 * value(c)));
        CHECK(same(value(dot(p, q)), value(p[0]) * value(q[0]) + value(p[1]) * value(q[1]) +
                                         value(p[2]) * value(q[2])));
        CHECK(same(value(out[2]), value(p[0]) * value(q[1]) - value(p[1]) * value(q[0])));
        CHECK(same(value(dot(out, product(bernstein::constant(1, 0, 0), p))), 0));
    });
}

TEST_CASE("2: parts and derivatives along either parameter") {
    RandomTensors random;
    const Tensor a = random.next(4, 3);
    const Tensor low = part(a, 0, 0.25, 0.75), high = part(a, 1, 0.4, 1);
    const Tensor du = derivative(a, 0), dv = derivative(a, 1);
    constexpr double step = 1e-4;
    for_each_place([&](double u, double v) {
        CHECK(same(evaluate(low, u, v), evaluate(a, 0.25 + 0.5 * u, v)));
        CHECK(same(evaluate(high, u, v), evaluate(a, u, 0.4 + 0.6 * v)));
        const double along_u = evaluate(a, u + step, v) - evaluate(a, u - step, v);
        const double along_v = evaluate(a, u, v + step) - evaluate(a, u, v - step);
        CHECK(std::abs(evaluate(du, u, v) - along_u / (2 * step)) < 1e-5);
        CHECK(std::abs(evaluate(dv, u, v) - along_v / (2 * step)) < 1e-5);
    });
    for (const double c : derivative(random.next(0, 2), 0).coefficients) CHECK(c == 0);
}

TEST_CASE("2: what vanishes on a side is a product with the distance from it") {
    RandomTensors random;
    for (const bernstein::Side& side : bernstein::sides) {
        const Tensor a = random.next(3, 4);
        Tensor distance =
            side.along == 0 ? bernstein::constant(0, 1, 0) : bernstein::constant(0, 0, 1);
        distance.coefficients[side.at_end ? 0 : 1] = 1;
        const Tensor vanishing = product(a, distance);
        CHECK(largest_on(vanishing, side) == 0);
        CHECK(largest_on(a, side) > 0);
        const Tensor quotient = divided_by_distance(vanishing, side);
        for_each_place(
            [&](double u, double v) { CHECK(same(evaluate(quotient, u, v), evaluate(a, u, v))); });
    }
}
