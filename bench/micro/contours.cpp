// From curves to what a layer is made of: arcs, joined contours, hatches.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "kernel/contour/contour.h"
#include "kernel/contour/fit.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/toolpath/hatch.h"

namespace {

using namespace lyr;

constexpr double pi = std::numbers::pi;
constexpr double semi_major_mm = 20, semi_minor_mm = 7;

CurvePoint on_ellipse(double t) {
    const Vector2 tangent(-semi_major_mm * std::sin(t), semi_minor_mm * std::cos(t));
    return {{semi_major_mm * std::cos(t), semi_minor_mm * std::sin(t)}, tangent.normalized()};
}

void arc_fit_ellipse(benchmark::State& state) {
    const Tolerance tolerance;
    const Point2 start = on_ellipse(0).point, end = on_ellipse(pi).point;
    std::vector<Segment> segments;
    for (auto _ : state) {
        segments.clear();
        fit_arcs(on_ellipse, 0, pi, start, end, tolerance.fit_mm(), segments);
        benchmark::DoNotOptimize(segments.data());
    }
}

// As a tracked curve comes, a point every few hundredths of a radian; the time is a point's.
void arc_fit_points(benchmark::State& state) {
    constexpr int count = 200;
    const Tolerance tolerance;
    std::vector<CurvePoint> points;
    for (int i = 0; i <= count; ++i) points.push_back(on_ellipse(pi * i / count));
    std::vector<Segment> segments;
    for (auto _ : state) {
        segments.clear();
        fit_arcs(points, tolerance.fit_mm(), segments);
        benchmark::DoNotOptimize(segments.data());
    }
    state.SetItemsProcessed(state.iterations() * count);
}

// A rounded rectangle whose sides and corners come in pieces, as neighbouring faces leave them.
Path rounded_rectangle() {
    Path path{{20, 7}, {}};
    constexpr double radius = 3;
    const Vector2 centres[] = {{17, 7}, {-17, 7}, {-17, -7}, {17, -7}};
    for (int corner = 0; corner < 4; ++corner) {
        for (const double turns : {0.5, 1.0}) {
            const double angle = (corner + turns) * pi / 2;
            const Point2 from = path.segments.empty() ? path.start : path.segments.back().end;
            const Point2 to = centres[corner] + radius * Vector2(std::cos(angle), std::sin(angle));
            path.segments.push_back(arc_with_sweep(from, to, pi / 4));
        }
        const double out = (corner + 1) * pi / 2;
        const Point2 from = path.segments.back().end;
        const Point2 to =
            centres[(corner + 1) % 4] + radius * Vector2(std::cos(out), std::sin(out));
        path.segments.push_back({(from + to) / 2});
        path.segments.push_back({corner == 3 ? path.start : to});
    }
    return path;
}

void join_contour(benchmark::State& state) {
    const Path path = rounded_rectangle();
    const Tolerance tolerance;
    for (auto _ : state) benchmark::DoNotOptimize(simplified(path, tolerance.trace_mm()));
}

// The time is a hatch line's.
void hatch_plate_with_bore(benchmark::State& state) {
    const std::vector<Contour> region{rounded_rectangle(), FullCircle{{5, 1}, 4, false}};
    std::size_t lines = 0;
    for (auto _ : state) {
        const Hatch lines_of_layer = hatch(region, pi / 4, 0.4);
        lines += lines_of_layer.spans.size();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(lines));
}

BENCHMARK(arc_fit_ellipse);
BENCHMARK(arc_fit_points);
BENCHMARK(join_contour);
BENCHMARK(hatch_plate_with_bore);

}  // namespace
