// Sections at given heights, as lines of JSON.

#include <algorithm>
#include <cstdio>

#include "base/read_text.h"
#include "base/replace_file.h"
#include "base/text.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace lyr::slicer {
namespace {

// Millions of heights; what is longer is another kind of file.
constexpr std::size_t most_heights_bytes = std::size_t{64} << 20;

}  // namespace

std::string to_json(const SectionFigures& figures) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "{\"z\":%s,\"area_mm2\":%.12g,\"length_mm\":%.12g,\"loops\":%zu,\"lines\":%zu,"
                  "\"arcs\":%zu,\"open\":%u}\n",
                  shortest(figures.z_mm).c_str(), figures.area_mm2, figures.length_mm,
                  figures.loops, figures.lines, figures.arcs, figures.open);
    return text;
}

Result<std::vector<double>> read_heights(const std::string& path) {
    const auto text = read_text(path, most_heights_bytes);
    if (!text) return text.error();
    std::vector<double> heights;
    std::uint32_t number = 0;
    for (std::string_view rest = *text; !rest.empty();) {
        ++number;
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line[first] == '#') continue;
        const auto word = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
        const auto height = finite_number(word);
        if (!height) {
            return Diagnostic{Severity::error,
                              ExitStatus::input,
                              "expected a height in mm, found " + in_quotes(word),
                              {.file = path == "-" ? standard_input_name : path, .line = number}};
        }
        heights.push_back(*height);
    }
    return heights;
}

Result<Summary> section_at(const Model& model, const std::vector<double>& heights_mm,
                           const std::string& report_path, const Options& options,
                           const Progress& progress, Diagnostics& diagnostics) {
    auto report = ReplaceFile::open(report_path);
    if (!report) return report.error();
    const Cutter cutter(model, options.tolerance());
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
    if (open > 0 && !options.allow_open) {
        return Diagnostic{Severity::error,
                          ExitStatus::geometry,
                          counted(open, "contour") + " cannot be closed (see above)",
                          {}};
    }
    if (Status written = report->commit(); !written) return written.error();
    return summary;
}

}  // namespace lyr::slicer
