// The section of one surface with one plane: finding the components, and tracing one of them whole.

#include <benchmark/benchmark.h>

#include <array>

#include "kernel/freeform_solids.h"
#include "kernel/section/cutter.h"
#include "kernel/section/surface_section.h"
#include "kernel/solids.h"

namespace {

using namespace lyr;
using lyr::testing::Builder;

constexpr double extent_mm = 100;
constexpr std::array<double, 8> heights_mm{0.13, -0.71, 0.37, 0.93, -0.53, -0.05, 0.83, -0.29};

void whole(benchmark::State& state, const Surface& surface) {
    const Tolerance tolerance;
    std::size_t i = 0;
    for (auto _ : state) {
        const double z = heights_mm[i++ % heights_mm.size()];
        const SurfaceSection section = section_of(surface, true, z, extent_mm);
        benchmark::DoNotOptimize(whole_component(section, 0, tolerance));
    }
}

Frame upright() {
    return Builder::frame_at({1, 2, 0});
}
Frame leaning() {
    return Builder::looking({1, 2, 0}, Vector3(0.3, 0.2, 1).normalized());
}

// A plane's line between two crossings.
void section_plane(benchmark::State& state) {
    const Surface plane = Plane{leaning()};
    const Tolerance tolerance;
    std::vector<Segment> segments;
    std::size_t i = 0;
    for (auto _ : state) {
        const double z = heights_mm[i++ % heights_mm.size()];
        const SurfaceSection section = section_of(plane, true, z, extent_mm);
        const CurvePoint on = at(section, {0, 1});
        const Point2 end = on.point + 5 * on.tangent;
        segments.clear();
        trace(section, 0, 1, 6, on.point, end, tolerance, segments);
        benchmark::DoNotOptimize(segments.data());
    }
}
void section_cylinder_across(benchmark::State& state) {
    whole(state, Cylinder{upright(), 8});
}
void section_cylinder_oblique(benchmark::State& state) {
    whole(state, Cylinder{leaning(), 8});
}
void section_cone_across(benchmark::State& state) {
    whole(state, Cone{upright(), 8, 0.4});
}
void section_cone_oblique(benchmark::State& state) {
    whole(state, Cone{leaning(), 8, 0.4});
}
void section_sphere(benchmark::State& state) {
    whole(state, Sphere{upright(), 8});
}
void section_torus_across(benchmark::State& state) {
    whole(state, Torus{upright(), 20, 3});
}
void section_torus_oblique(benchmark::State& state) {
    whole(state, Torus{leaning(), 20, 3});
}

// Six free-form faces and their twelve edges, with everything that a cutter does.
void cut_freeform_cube(benchmark::State& state, bool rational) {
    const Model model = lyr::testing::bent_cube({3, 20, 0.3, rational, 1});
    const Cutter cutter(model, {});
    for (const double z : heights_mm) (void)cutter.cut(z);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(cutter.cut(heights_mm[i++ % heights_mm.size()]));
}
void cut_bspline_cube(benchmark::State& state) {
    cut_freeform_cube(state, false);
}
void cut_rational_bspline_cube(benchmark::State& state) {
    cut_freeform_cube(state, true);
}

BENCHMARK(section_plane);
BENCHMARK(section_cylinder_across);
BENCHMARK(section_cylinder_oblique);
BENCHMARK(section_cone_across);
BENCHMARK(section_cone_oblique);
BENCHMARK(section_sphere);
BENCHMARK(section_torus_across);
BENCHMARK(section_torus_oblique);
BENCHMARK(cut_bspline_cube);
BENCHMARK(cut_rational_bspline_cube);

}  // namespace
