#include "bench/sections.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "bench/measure.h"
#include "bench/occt.h"
#include "kernel/section/cutter.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace lyr::bench {
namespace {

constexpr int our_runs = 7;
constexpr double our_enough_s = 10;
constexpr std::size_t occt_planes = 20;
constexpr int occt_runs = 3;  // of a plane, the least counts
constexpr double occt_enough_s = 0.1;

// Boundaries as long as each other to this share are the same section: arcs within the tolerance change the length by
// far less, a lost edge by far more.
constexpr double length_agreement = 1e-3;

std::vector<double> heights_of_layers(const Model& model, const Tolerance& tolerance,
                                      double layer_height_mm) {
    const HeightRange range = Cutter(model, tolerance).height_range();
    auto heights = slicer::layer_middles(range.top_mm - range.bottom_mm, layer_height_mm);
    for (double& height : heights) height += range.bottom_mm;
    return heights;
}

struct OurTimes {
    Times preparation, planes, all;  // of a whole print
    std::vector<slicer::SectionFigures> figures;
};

// What the cutter makes at its first meeting with a face is preparation too: the first pass over the planes takes
// longer than the second by just that.
OurTimes our_times(const Model& model, const Tolerance& tolerance,
                   const std::vector<double>& heights) {
    OurTimes times;
    std::vector<double> preparation, planes, all;
    double spent_s = 0;
    for (int run = 0; run < our_runs && spent_s < our_enough_s; ++run) {
        std::optional<Cutter> cutter;
        const double construction_s = time_of_s([&] { cutter.emplace(model, tolerance); });
        const auto cut_all = [&] {
            for (const double z : heights) (void)cutter->cut(z);
        };
        const double first_s = time_of_s(cut_all), again_s = time_of_s(cut_all);
        all.push_back(construction_s + first_s);
        planes.push_back(std::min(first_s, again_s));
        preparation.push_back(all.back() - planes.back());
        spent_s += all.back() + again_s;
        if (run > 0) continue;
        for (const double z : heights) times.figures.push_back(slicer::figures_of(cutter->cut(z)));
    }
    times.preparation = summary(preparation);
    times.planes = summary(planes);
    times.all = summary(all);
    return times;
}

struct OcctTimes {
    std::vector<double> seconds;  // by plane
    std::size_t agree = 0, failed = 0;
};

OcctTimes occt_times(const occt::Part& part, const std::vector<slicer::SectionFigures>& ours) {
    OcctTimes times;
    const std::size_t count = std::min(occt_planes, ours.size());
    for (std::size_t i = 0; i < count; ++i) {
        const slicer::SectionFigures& figures = ours[(2 * i + 1) * ours.size() / (2 * count)];
        std::optional<occt::Part::Section> best;
        double spent_s = 0;
        for (int run = 0; run < occt_runs && spent_s < occt_enough_s; ++run) {
            const auto section = part.cut(figures.z_mm);
            if (!section) break;
            spent_s += section->seconds;
            if (!best || section->seconds < best->seconds) best = section;
        }
        if (!best) {
            ++times.failed;
            continue;
        }
        times.seconds.push_back(best->seconds);
        const double apart_mm = std::abs(best->length_mm - figures.length_mm);
        if (apart_mm <= length_agreement * figures.length_mm && best->wires == figures.loops)
            ++times.agree;
    }
    return times;
}

std::string range(const Times& times, double share) {
    return duration(times.least_s * share) + " to " + duration(times.greatest_s * share);
}

struct Cut {
    std::size_t faces;
    OurTimes times;

    double share() const { return 1 / static_cast<double>(times.figures.size()); }
    double all_in_s() const { return times.all.median_s * share(); }
};

Result<Cut> cut(const PartToCut& part) {
    const slicer::Options options;
    Diagnostics found;
    const auto model = slicer::load(part.path, options, found);
    if (!model) return model.error();
    const auto heights = heights_of_layers(*model, options.tolerance(), part.layer_height_mm);
    Cut cut{model->faces.size(), our_times(*model, options.tolerance(), heights)};
    for (const slicer::SectionFigures& figures : cut.times.figures) {
        if (figures.open == 0) continue;
        return Diagnostic{Severity::error,
                          ExitStatus::geometry,
                          std::to_string(figures.open) + " contour ends do not close",
                          {.file = part.path, .z_mm = figures.z_mm}};
    }
    if (!heights.empty()) return cut;
    return Diagnostic{
        Severity::error, ExitStatus::geometry, "lower than half a layer", {.file = part.path}};
}

std::vector<std::string> our_row(const std::string& name, const PartToCut& part, const Cut& cut) {
    const OurTimes& times = cut.times;
    return {name + " at " + number(part.layer_height_mm) + " mm",
            std::to_string(cut.faces),
            std::to_string(times.figures.size()),
            duration(times.preparation.median_s),
            duration(times.planes.median_s * cut.share()),
            duration(cut.all_in_s()),
            range(times.all, cut.share())};
}

// And the ratio of OCCT's median plane to ours.
std::pair<std::vector<std::string>, double> occt_row(const std::string& name, const PartToCut& part,
                                                     const Cut& cut) {
    const auto occt = occt::Part::read(part.path);
    const OcctTimes theirs = occt ? occt_times(*occt, cut.times.figures) : OcctTimes{};
    if (theirs.seconds.empty())
        return {{name, "cannot be read or cut", "-", "-", "-", "-", "-"}, NAN};
    const Times times = summary(theirs.seconds);
    const double ratio = times.median_s / cut.all_in_s();
    const std::string planes = std::to_string(theirs.seconds.size());
    const std::string failed =
        theirs.failed ? ", " + std::to_string(theirs.failed) + " failed" : "";
    return {
        {name, planes + " planes" + failed, std::to_string(theirs.agree) + " of " + planes,
         duration(occt->preparation_s()), duration(times.median_s), range(times, 1), number(ratio)},
        ratio};
}

}  // namespace

void compare_sections(const std::vector<PartToCut>& parts, Requirements& requirements) {
    Table ours{"Sections, ours: all planes of the print, median of up to " +
                   std::to_string(our_runs) + " runs",
               {"part", "faces", "planes", "preparation", "a further plane", "a plane, all in",
                "runs, all in"},
               {}};
    Table occt{
        "Sections, OCCT: a sample of the same planes, without its preparation; the ratio to ours, "
        "all in",
        {"part", "sample", "same section", "preparation", "a plane (median)", "planes", "ratio"},
        {}};
    for (const PartToCut& part : parts) {
        const std::string name = std::filesystem::path(part.path).filename();
        double ratio = NAN;
        if (const auto done = cut(part)) {
            ours.rows.push_back(our_row(name, part, *done));
            auto [row, times_faster] = occt_row(name, part, *done);
            occt.rows.push_back(std::move(row));
            ratio = times_faster;
        } else {
            std::fprintf(stderr, "bench_compare: %s\n", to_string(done.error()).c_str());
            ours.rows.push_back({name, "cannot be read or cut", "-", "-", "-", "-", "-"});
        }
        if (part.required_ratio) {
            requirements.push_back(
                {name + ": sections, times OCCT's speed", ratio, *part.required_ratio});
        }
    }
    print(ours);
    print(occt);
}

}  // namespace lyr::bench
