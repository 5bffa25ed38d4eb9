// Layers as bytes of a .lyr file; the time is an operation's.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "format/writer.h"

namespace {

using namespace lyr::format;

constexpr Quantum quantum{1000};
constexpr int operations = 10000;

// A walk within a bed's bounds that never repeats a step.
struct Walk {
    double x_mm = 0, y_mm = 0;
    void step(int i) {
        x_mm = 100 * std::sin(0.011 * i);
        y_mm = 100 * std::cos(0.017 * i);
    }
};

template <class Fill>
void encode(benchmark::State& state, std::int64_t count, Fill fill) {
    for (auto _ : state) {
        LayerEncoder layer(quantum, {});
        layer.begin_path({Role::outer_wall, 0.45, 0.2, 1, 60, 0});
        fill(layer);
        const auto encoded = layer.finish();
        if (!encoded) state.SkipWithError("a layer was refused");
        benchmark::DoNotOptimize(encoded->bytes.data());
    }
    state.SetItemsProcessed(state.iterations() * count);
}

void encode_lines(benchmark::State& state) {
    encode(state, operations, [](LayerEncoder& layer) {
        Walk walk;
        for (int i = 1; i <= operations; ++i) {
            walk.step(i);
            layer.line_to(walk.x_mm, walk.y_mm);
        }
    });
}

void encode_arcs(benchmark::State& state) {
    encode(state, operations, [](LayerEncoder& layer) {
        Walk walk;
        for (int i = 1; i <= operations; ++i) {
            walk.step(i);
            layer.arc_to(walk.x_mm, walk.y_mm, i % 2 ? 0.05 : -0.07);
        }
    });
}

void encode_hatch_lines(benchmark::State& state) {
    std::vector<HatchRow> rows;
    std::vector<HatchInterval> intervals;
    for (int r = 0; r < 500; ++r) {
        const double half_mm = 100 * std::sin(0.006 * (r + 1));
        rows.push_back({1, r > 0});
        intervals.push_back({-half_mm, half_mm});
    }
    const HatchRun run{.direction_x = 0.6,
                       .direction_y = 0.8,
                       .offset_mm = -100,
                       .pitch_mm = 0.4,
                       .one_way = false,
                       .rows = rows,
                       .intervals = intervals};
    encode(state, static_cast<std::int64_t>(rows.size()),
           [&](LayerEncoder& layer) { layer.hatch(run); });
}

BENCHMARK(encode_lines);
BENCHMARK(encode_arcs);
BENCHMARK(encode_hatch_lines);

}  // namespace
