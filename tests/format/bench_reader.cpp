// How fast a .lyr file is written and read: processor time, best of five.

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

#include "format/crc32c.h"
#include "format/reader.h"
#include "format/writer.h"

namespace {

using namespace lyr::format;

constexpr Quantum quantum{1000};
constexpr int layers = 20, motions = 100000, runs = 5;

double processor_time_s() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

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
void measure(const char* name, Fill fill) {
    const std::string path = "bench_reader.lyr";
    double writing_s = processor_time_s();
    auto writer = Writer::create(path, quantum, {});
    if (!writer) return;
    for (int i = 0; i < layers; ++i) {
        LayerEncoder layer(quantum, {});
        layer.begin_path({Role::outer_wall, 0.45, 0.2, 1, 60, 0});
        fill(layer);
        const auto encoded = layer.finish();
        if (!encoded || !writer->append(*encoded)) return;
    }
    if (!writer->finish()) return;
    writing_s = processor_time_s() - writing_s;
    double reading_s = 1e9;
    std::uint64_t operations = 0, bytes = 0;
    for (int run = 0; run < runs; ++run) {
        const double start_s = processor_time_s();
        auto reader = Reader::open(path);
        if (!reader) return;
        for (operations = 0; reader->read(); ++operations) {
        }
        bytes = reader->position().end;
        reading_s = std::min(reading_s, processor_time_s() - start_s);
    }
    std::remove(path.c_str());
    const auto count = static_cast<double>(operations), size = static_cast<double>(bytes);
    std::printf(
        "%-8s %5.2f bytes each, read %6.1f million/s (%5.1f MB/s), written %5.1f million/s\n", name,
        size / count, count / reading_s / 1e6, size / reading_s / 1e6, count / writing_s / 1e6);
}

}  // namespace

int main() {
    measure("lines", [](LayerEncoder& layer) { lines_or_arcs(layer, false); });
    measure("arcs", [](LayerEncoder& layer) { lines_or_arcs(layer, true); });
    measure("hatches", hatches);
    const std::vector<std::byte> block(65536);
    constexpr int blocks = 4000;
    const double start_s = processor_time_s();
    std::uint32_t crc = 0;
    for (int i = 0; i < blocks; ++i) crc = crc32c(block, crc);
    const double size = blocks * static_cast<double>(block.size());
    std::printf("CRC-32C  %.0f MB/s (%08x)\n", size / (processor_time_s() - start_s) / 1e6, crc);
}
