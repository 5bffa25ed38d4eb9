#include "bench/scaling.h"

#include <array>
#include <cmath>
#include <vector>

#include "bench/measure.h"
#include "bench/occt.h"
#include "bench/scratch_file.h"
#include "bench/tower.h"
#include "kernel/section/cutter.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace lyr::bench {
namespace {

constexpr std::array<std::size_t, 4> storeys_of_towers{12, 125, 1250, 12500};
constexpr std::size_t planes_per_storey = 2;
constexpr std::size_t planes_a_run = 2400;  // at least; fewer would be at the clock's mercy
constexpr int runs = 15;
constexpr double enough_s = 5;
constexpr std::size_t occt_most_faces = 20000;  // beyond, reading alone takes OCCT minutes
constexpr std::size_t occt_planes = 9;

// The planes that every tower has are met as fast in a tower a thousand times as high: what grows is the depth of
// the search tree, from 7 to 17, and with it the memory that is cold.
constexpr double most_growth = 1.5;

constexpr double area_agreement = 1e-9;

std::vector<double> heights(std::size_t storeys) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < storeys * planes_per_storey; ++i) {
        heights.push_back((static_cast<double>(i) + 0.5) * tower_storey_mm / planes_per_storey);
    }
    return heights;
}

Times time_a_plane(const Cutter& cutter, const std::vector<double>& heights) {
    const std::size_t passes = 1 + planes_a_run / heights.size();
    const Times times = repeat(runs, enough_s, [&] {
        for (std::size_t pass = 0; pass < passes; ++pass) {
            for (const double z : heights) (void)cutter.cut(z);
        }
    });
    const double share = 1 / static_cast<double>(passes * heights.size());
    return {times.least_s * share, times.median_s * share, times.greatest_s * share};
}

Status check(const Cutter& cutter, const std::vector<double>& heights, const std::string& path) {
    for (const double z : heights) {
        const slicer::SectionFigures figures = slicer::figures_of(cutter.cut(z));
        const bool right =
            figures.open == 0 && figures.loops == 1 &&
            std::abs(figures.area_mm2 - tower_area_mm2()) <= area_agreement * tower_area_mm2();
        if (right) continue;
        return Diagnostic{
            Severity::error,
            ExitStatus::internal,
            "a section of the tower is not the rounded square: " + slicer::to_json(figures),
            {.file = path, .z_mm = z}};
    }
    return Done{};
}

std::string occt_time_a_plane(const std::string& path, std::size_t faces,
                              const std::vector<double>& heights) {
    if (faces > occt_most_faces) return "not tried";
    const auto part = occt::Part::read(path);
    if (!part) return "cannot read";
    std::vector<double> seconds;
    for (std::size_t i = 0; i < occt_planes; ++i) {
        const auto section = part->cut(heights[(2 * i + 1) * heights.size() / (2 * occt_planes)]);
        if (section) seconds.push_back(section->seconds);
    }
    return seconds.empty() ? "cannot cut" : duration(median(seconds));
}

}  // namespace

Status compare_scaling(Requirements& requirements) {
    Table table{
        "A further plane in towers of many faces, eight of which it meets; the fastest of " +
            std::to_string(runs) + " runs",
        {"faces", "same low planes", "all planes", "median / fastest", "preparation a face",
         "OCCT a plane"},
        {}};
    const std::vector<double> low = heights(storeys_of_towers.front());
    std::vector<double> low_s;
    for (const std::size_t storeys : storeys_of_towers) {
        const auto file = ScratchFile::with(tower_step(storeys));
        if (!file) return file.error();
        const slicer::Options options;
        Diagnostics found;
        const auto model = slicer::load(file->path(), options, found);
        if (!model) return model.error();
        std::optional<Cutter> cutter;
        const Times preparation =
            repeat(runs, enough_s, [&] { cutter.emplace(*model, options.tolerance()); });
        const std::vector<double> all = heights(storeys);
        if (Status right = check(*cutter, all, file->path()); !right) return right;

        const std::size_t faces = model->faces.size();
        const Times of_low = time_a_plane(*cutter, low), of_all = time_a_plane(*cutter, all);
        low_s.push_back(of_low.least_s);
        table.rows.push_back({std::to_string(faces), duration(of_low.least_s),
                              duration(of_all.least_s), number(of_low.median_s / of_low.least_s),
                              duration(preparation.least_s / static_cast<double>(faces)),
                              occt_time_a_plane(file->path(), faces, all)});
    }
    print(table);
    requirements.push_back({.what = "the same plane with a thousand times the faces, times as long",
                            .measured = low_s.back() / low_s.front(),
                            .wanted = most_growth,
                            .at_most = true});
    return Done{};
}

}  // namespace lyr::bench
