// One crossing of a plane with an edge: the parameter at the height, and the point there.

#include <benchmark/benchmark.h>

#include <array>
#include <numbers>

#include "kernel/geometry/curve.h"

namespace {

using namespace lyr;

// So that no height is met twice in a row: the branch predictor learns nothing of the curve.
constexpr std::array<double, 8> shares{0.13, 0.71, 0.37, 0.93, 0.53, 0.05, 0.83, 0.29};

// Of a curve whose height is monotone between the two parameters.
void cross(benchmark::State& state, const Curve& curve, double from, double to) {
    const double low = evaluate(curve, from).z(), high = evaluate(curve, to).z();
    std::size_t i = 0;
    for (auto _ : state) {
        const double z = low + shares[i++ % shares.size()] * (high - low);
        benchmark::DoNotOptimize(evaluate(curve, parameter_at_height(curve, from, to, z)));
    }
}

// Leaning, so that no axis is special.
Frame leaning() {
    Frame frame;
    frame.z = Vector3(0.6, -0.64, 0.48);
    frame.x = Vector3(0.8, 0.48, -0.36);
    frame.y = frame.z.cross(frame.x);
    return frame;
}

// Where the height of a conic about the origin turns next after `from`.
double next_turn(const Curve& curve, double from) {
    return height_extrema(curve, from, from + 2 * std::numbers::pi).front();
}

void conic(benchmark::State& state, const Curve& curve) {
    const double from = next_turn(curve, 0);
    cross(state, curve, from, next_turn(curve, from + 1e-3));
}

BSplineCurve cubic(bool rational) {
    BSplineCurve curve{3, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}, {}, {}};
    for (int i = 0; i < 8; ++i) {
        curve.control_points.push_back({3.0 * (i % 3), 2.0 * (i % 2), 1.5 * i + 0.4 * (i % 2)});
        if (rational) curve.weights.push_back(1 + 0.3 * (i % 2));
    }
    return curve;
}

void crossing_line(benchmark::State& state) {
    cross(state, Line{{1, 2, 3}, Vector3(0.36, 0.48, 0.8)}, 0, 20);
}
void crossing_circle(benchmark::State& state) {
    conic(state, Circle{leaning(), 7});
}
void crossing_ellipse(benchmark::State& state) {
    conic(state, Ellipse{leaning(), 7, 4});
}
void crossing_bspline(benchmark::State& state) {
    cross(state, cubic(false), 0, 5);
}
void crossing_rational_bspline(benchmark::State& state) {
    cross(state, cubic(true), 0, 5);
}

BENCHMARK(crossing_line);
BENCHMARK(crossing_circle);
BENCHMARK(crossing_ellipse);
BENCHMARK(crossing_bspline);
BENCHMARK(crossing_rational_bspline);

}  // namespace
