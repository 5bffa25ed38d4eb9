#include "bench/lyr_kinds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "bench/measure.h"
#include "bench/scratch_file.h"
#include "format/reader.h"
#include "format/writer.h"

namespace lyr::bench {
namespace {

using namespace lyr::format;

constexpr Quantum quantum{1000};
constexpr int layers = 20, motions = 100000, runs = 5;

void lines_or_arcs(LayerEncoder& layer, bool arcs) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-3, 3);
    double x = 0, y = 0;
    for (int i = 0; i < motions; ++i) {
        double dx = uniform(random), dy = uniform(random);
        if (std::abs(x + dx) > 100) dx = -dx;
        if (std::abs(y + dy) > 100) dy = -dy;
        x += dx, y += dy;
        const double sagitta = 0.1 * std::hypot(dx, dy) * uniform(random);
        arcs ? layer.arc_to(x, y, sagitta) : layer.line_to(x, y);
    }
}

// Three at a time, each a circle in pieces.
void walls(LayerEncoder& layer) {
    constexpr int pieces = 100;
    for (int i = 0; i < motions / pieces; ++i) {
        const double radius = 20 + 0.01 * i + 0.4 * (i % 3);
        layer.travel_to(radius, 0);
        for (int k = 1; k <= pieces; ++k) {
            const double turn = 2 * std::numbers::pi / pieces;
            layer.arc_to(radius * std::cos(k * turn), radius * std::sin(k * turn),
                         radius * (1 - std::cos(turn / 2)));
        }
    }
}

void hatches(LayerEncoder& layer) {
    constexpr int rows_of_a_disc = 250;
    std::vector<HatchRow> rows;
    std::vector<HatchInterval> intervals;
    for (int r = 0; r < rows_of_a_disc; ++r) {
        const double off = (r - rows_of_a_disc / 2) * 0.45, half = std::sqrt(1e4 - off * off);
        rows.push_back({1, r > 0});
        intervals.push_back({-half, half});
    }
    HatchRun run;
    run.direction_x = run.direction_y = std::numbers::sqrt2 / 2;
    run.offset_mm = -rows_of_a_disc / 2 * 0.45;
    run.pitch_mm = 0.45;
    run.rows = rows;
    run.intervals = intervals;
    for (int i = 0; i < motions / 2 / rows_of_a_disc; ++i) layer.hatch(run);
}

template <class Fill>
bool write(const std::string& path, Fill fill) {
    auto writer = Writer::create(path, quantum, {});
    if (!writer) return false;
    for (int i = 0; i < layers; ++i) {
        LayerEncoder layer(quantum, {});
        layer.begin_path({Role::outer_wall, 0.45, 0.2, 1, 60, 0});
        fill(layer);
        const auto encoded = layer.finish();
        if (!encoded || !writer->append(*encoded)) return false;
    }
    return writer->finish().ok();
}

template <class Fill>
void measure(Table& table, const std::string& name, Fill fill) {
    auto file = ScratchFile::with("");
    if (!file) return;
    bool whole = false;
    const double writing_s = time_of_s([&] { whole = write(file->path(), fill); });
    if (!whole) return;
    double reading_s = 1e9, operations = 0, bytes = 0;
    for (int run = 0; run < runs; ++run) {
        operations = 0;
        reading_s = std::min(reading_s, time_of_s([&] {
                                 auto reader = Reader::open(file->path());
                                 while (reader && reader->read()) ++operations;
                                 if (reader) bytes = static_cast<double>(reader->position().end);
                             }));
    }
    constexpr double million = 1e6;
    table.rows.push_back({name, number(bytes / operations),
                          number(operations / reading_s / million) + " million/s",
                          number(bytes / reading_s / million) + " MB/s",
                          number(operations / writing_s / million) + " million/s"});
}

}  // namespace

Table time_lyr_kinds() {
    Table table{"Kinds of operations", {"kind", "bytes each", "read", "", "written"}, {}};
    measure(table, "random lines", [](LayerEncoder& layer) { lines_or_arcs(layer, false); });
    measure(table, "random arcs", [](LayerEncoder& layer) { lines_or_arcs(layer, true); });
    measure(table, "walls beside each other", walls);
    measure(table, "hatch lines", hatches);
    return table;
}

}  // namespace lyr::bench
