// stepc: slices a STEP file into a .lyr print, or reports sections at given heights.

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/command_line.h"
#include "apps/files.h"
#include "apps/progress_line.h"
#include "apps/signal_watch.h"
#include "base/read_text.h"
#include "base/text.h"
#include "slicer/slicer.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::string step_path, lyr_path, heights_path, report_path;
    std::array<double, 3> up{0, 0, 1};
    std::array<double, 2> bed_position_mm{0, 0};
    slicer::Options options;

    bool sections() const { return !heights_path.empty(); }
    std::vector<NamedFile> outputs() const {
        return {{"the print", lyr_path}, {"the report", report_path}};
    }
};

constexpr Program program{
    "stepc", "Slices a STEP file into a print of lines and true arcs.",
    "Examples:\n"
    "  stepc part.step -o part.lyr                        slice at 0.2 mm\n"
    "  stepc part.step -o part.lyr --layer-height 0.1     finer\n"
    "  stepc part.step -o part.lyr --up 0,-1,0            print it lying on another side\n"
    "  stepc part.step --section-at z.txt --report s.jsonl   areas at heights of your own\n"
    "  stepc part.step -o - | lyrview - --info            into a pipe\n"
    "\n"
    "Layer i is the section at its middle, (i - 1/2) x layer height over the bed; there are as "
    "many\n"
    "layers as have their middle below the part's top.\n"
    "The summary goes to standard error where the print or the report goes to standard output.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 5 geometry, 6 output, 8 stopped "
    "on\n"
    "request.\n"};

// As far as a printer's axes may reach (docs/configuration.md).
constexpr NumberRange bed_mm{-10'000, 10'000, "mm"};
// Only the direction counts; no vector that means one is longer.
constexpr NumberRange direction{-1'000, 1'000, ""};

void add_files(CLI::App& app, Arguments& arguments) {
    add_file(app, "part", arguments.step_path,
             "STEP file (ISO 10303-21; AP203, AP214, AP242); -: standard input")
        ->required();
    add_file(app, "-o,--output", arguments.lyr_path,
             "The print to write; -: standard output; without it, the part's name with .lyr");
    add_file(app, "--section-at", arguments.heights_path,
             "Only cut, at the heights of this file (mm, the model's own coordinates, one a line); "
             "-: standard input; needs --report");
    add_file(app, "--report", arguments.report_path,
             "Write a line of JSON a section: area, length, loops, lines, arcs, open ends; -: "
             "standard output");
}

void add_options(CLI::App& app, Arguments& arguments) {
    slicer::Options& options = arguments.options;
    const auto add_number = [&app](const char* option, const char* shape, double& value,
                                   const NumberRange& range, const char* text) {
        add_numbers(app, option, shape, {&value, 1}, range, text);
    };
    add_files(app, arguments);
    add_number("--layer-height", "MM", options.layer_height_mm, {0.001, 10, "mm"},
               "Thickness of a layer");
    add_number("--tolerance", "MM", options.tolerance.total_mm, {1e-5, 1, "mm"},
               "Greatest distance of the printed contour from the exact section");
    add_numbers(app, "--up", "X,Y,Z", arguments.up, direction,
                "Build direction in the model's coordinates, of any length");
    add_numbers(app, "--at", "X,Y", arguments.bed_position_mm, bed_mm,
                "Where on the bed the part's corner lies");
    add_number("--line-width", "MM", options.line_width_mm, {0.01, 10, "mm"},
               "Width of an extruded line");
    add_number("--wall-speed", "MM/S", options.wall_speed_mm_s, {0.1, 2000, "mm/s"},
               "Speed along contours");
    add_number("--infill-speed", "MM/S", options.infill_speed_mm_s, {0.1, 2000, "mm/s"},
               "Speed of the fill");
    add_number("--nozzle-temp", "DEG_C", options.nozzle_temp_c, {0, 500, "deg C"},
               "Nozzle temperature, 0: off");
    add_number("--bed-temp", "DEG_C", options.bed_temp_c, {0, 200, "deg C"},
               "Bed temperature, 0: off");
    add_flag(app, "--allow-open", options.allow_open,
             "Leave out contours that do not close instead of stopping");
    add_flag(app, "--strict", options.strict,
             "Refuse a part with geometric defects (gaps, wrong directions) instead of healing it");
    add_count(app, "--threads", "N  [0]", options.threads, {0, 1024},
              "0: one a processor; the result is the same for any number");
}

std::string summary_text(const Arguments& arguments, const slicer::Summary& summary,
                         std::size_t findings, double time_s) {
    std::string text = input_name(arguments.step_path) + ": " + counted(summary.solids, "solid") +
                       ", " + counted(summary.faces, "face") + '\n' +
                       counted(summary.layers, arguments.sections() ? "section" : "layer") + ": " +
                       counted(summary.contours, "contour") + " (" +
                       counted(summary.circles, "full circle") + "), " +
                       counted(summary.lines, "line") + ", " + counted(summary.arcs, "arc") + '\n';
    if (summary.united_layers > 0) {
        text += "solids overlap or touch in " + counted(summary.united_layers, "layer") +
                " and are printed as one";
        if (summary.slivers > 0) {
            text += "; " + counted(summary.slivers, "sliver") + " within the tolerance left out";
        }
        text += '\n';
    }
    char line[160];
    if (arguments.sections()) {
        text += output_name(arguments.report_path);
    } else {
        const auto size = summary.box.sizes();
        std::snprintf(line, sizeof line,
                      "%.3f x %.3f x %.3f mm at %g mm a layer, tolerance %g mm\n", size.x(),
                      size.y(), size.z(), arguments.options.layer_height_mm,
                      arguments.options.tolerance.total_mm);
        text += line + output_name(arguments.lyr_path) + ": " + counted(summary.bytes, "byte");
    }
    std::snprintf(line, sizeof line, ", %.2f s, ", time_s);
    return text + line + counted(findings, "finding") + '\n';
}

Result<slicer::Summary> slice(const Arguments& arguments, ProgressLine& line,
                              Diagnostics& diagnostics) {
    const auto progress = [&](const char* stage, std::size_t done, std::size_t total) {
        line.show(stage + (' ' + std::to_string(done)) + " of " + std::to_string(total));
    };
    std::vector<double> heights;
    if (arguments.sections()) {
        auto read = slicer::read_heights(arguments.heights_path);
        if (!read) return read.error();
        heights = std::move(*read);
    }
    line.show("reading");
    auto model = slicer::load(arguments.step_path, arguments.options, diagnostics);
    if (!model) return model.error();
    if (arguments.sections()) {
        return slicer::section_at(*model, heights, arguments.report_path, arguments.options,
                                  progress, diagnostics);
    }
    const std::string name = arguments.step_path == "-"
                                 ? standard_input_name
                                 : std::filesystem::path(arguments.step_path).filename().string();
    return slicer::print(std::move(*model), name, arguments.lyr_path, arguments.report_path,
                         arguments.options, progress, diagnostics);
}

// What the options say together, and the name of the print where they do not say it.
Status complete(Arguments& arguments) {
    const Vector3 up(arguments.up.data());
    const double longest = up.cwiseAbs().maxCoeff();
    if (!(longest > 0)) return usage("--up: 0,0,0 is no direction");
    arguments.options.up = up / longest;  // so that no square of a component underflows
    arguments.options.bed_position_mm = Point2(arguments.bed_position_mm.data());
    if (arguments.sections() && arguments.report_path.empty())
        return usage("--section-at needs --report FILE");
    if (arguments.sections() && !arguments.lyr_path.empty())
        return usage("--section-at writes no print: leave out -o");
    if (!arguments.sections() && arguments.lyr_path.empty()) {
        if (arguments.step_path == "-") return usage("a part from standard input needs -o FILE");
        arguments.lyr_path = std::filesystem::path(arguments.step_path).replace_extension(".lyr");
    }
    return check_apart({{"the part", arguments.step_path}, {"the heights", arguments.heights_path}},
                       arguments.outputs());
}

Status work(Arguments& arguments) {
    if (const Status completed = complete(arguments); !completed) return completed;
    const SignalWatch watch(program.name);
    const auto begin = std::chrono::steady_clock::now();
    ProgressLine line;
    Diagnostics diagnostics;
    const auto summary = slice(arguments, line, diagnostics);
    line.clear();
    show(program, diagnostics);
    if (!summary) return summary.error();
    const std::chrono::duration<double> time_s = std::chrono::steady_clock::now() - begin;
    return tell(summary_text(arguments, *summary, diagnostics.size(), time_s.count()),
                arguments.outputs());
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](CLI::App& app) { add_options(app, arguments); },
        [&](const CLI::App&) { return work(arguments); });
}
