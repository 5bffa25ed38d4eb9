// Sections at given heights, as lines of JSON.

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/replace_file.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace lyr::slicer {

std::string to_json(const SectionFigures& figures) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "{\"z\":%.17g,\"area_mm2\":%.12g,\"length_mm\":%.12g,\"loops\":%zu,\"lines\":%zu,"
                  "\"arcs\":%zu,\"open\":%u}\n",
                  figures.z_mm, figures.area_mm2, figures.length_mm, figures.loops, figures.lines,
                  figures.arcs, figures.open);
    return text;
}

Result<std::vector<double>> read_heights(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        return Diagnostic{
            Severity::error, ExitStatus::input, "cannot read the heights", {.file = path}};
    std::vector<double> heights;
    std::string line;
    for (std::uint32_t number = 1; std::getline(file, line); ++number) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos || line[first] == '#') continue;
        const std::size_t last = line.find_last_not_of(" \t\r") + 1;
        double height = 0;
        const auto [end, error] = std::from_chars(line.data() + first, line.data() + last, height);
        if (error != std::errc() || end != line.data() + last || !std::isfinite(height)) {
            return Diagnostic{Severity::error,
                              ExitStatus::input,
                              "expected a height in mm, found \"" + line + '"',
                              {.file = path, .line = number}};
        }
        heights.push_back(height);
    }
    if (file.bad())
        return Diagnostic{
            Severity::error, ExitStatus::input, "cannot read the heights", {.file = path}};
    return heights;
}

Result<Summary> section_at(const Model& model, const std::vector<double>& heights_mm,
                           const std::string& report_path, const Options& options,
                           const Progress& progress, Diagnostics& diagnostics) {
    auto report = ReplaceFile::open(report_path);
    if (!report) return report.error();
    const Cutter cutter(model, options.tolerance);
    Summary summary{.solids = model.solids.size(), .faces = model.faces.size()};
    std::uint32_t open = 0;
    in_order(
        heights_mm.size(), thread_count(options),
        [&](std::size_t i) { return cutter.cut(heights_mm[i]); },
        [&](std::size_t i, Section section) {
            const SectionFigures figures = figures_of(section);
            report->write(to_json(figures));
            diagnostics.insert(diagnostics.end(), section.diagnostics.begin(),
                               section.diagnostics.end());
            open += section.open;
            ++summary.layers;
            summary.contours += figures.loops;
            summary.circles += figures.circles;
            summary.lines += figures.lines;
            summary.arcs += figures.arcs;
            progress("cutting", i + 1, heights_mm.size());
            return true;
        });
    if (Status written = report->commit(); !written) return written.error();
    if (open > 0 && !options.allow_open) {
        return Diagnostic{Severity::error,
                          ExitStatus::geometry,
                          std::to_string(open) + " contour ends do not close (see the warnings)",
                          {}};
    }
    return summary;
}

}  // namespace lyr::slicer
