// stepc: slices a STEP file into a .lyr print, or reports sections at given heights.

#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "slicer/slicer.h"

namespace {

using namespace lyr;

struct Arguments {
    std::string step_path, lyr_path, heights_path, report_path;
    std::vector<double> up{0, 0, 1}, bed_position{0, 0};
    slicer::Options options;
};

constexpr const char* examples =
    "Examples:\n"
    "  stepc part.step -o part.lyr                        slice at 0.2 mm\n"
    "  stepc part.step -o part.lyr --layer-height 0.1     finer\n"
    "  stepc part.step -o part.lyr --up 0,-1,0            print it lying on another side\n"
    "  stepc part.step --section-at z.txt --report s.jsonl   areas at heights of your own\n"
    "\n"
    "Layer i is the section at its middle, (i - 1/2) x layer height over the bed; there are as "
    "many\n"
    "layers as have their middle below the part's top.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 5 geometry, 6 output.\n";

// An option for a number within bounds, shown with its unit and default.
void add_number(CLI::App& app, const std::string& name, double& target, double low, double high,
                const std::string& unit, const std::string& text) {
    char shown[64];
    std::snprintf(shown, sizeof shown, "%s  [%g]", unit.c_str(), target);
    app.add_option(name, target, text)->check(CLI::Range(low, high))->option_text(shown);
}

void add_files(CLI::App& app, Arguments& arguments) {
    app.add_option("part", arguments.step_path, "STEP file (ISO 10303-21; AP203, AP214, AP242)")
        ->required()
        ->option_text("FILE");
    app.add_option("-o,--output", arguments.lyr_path,
                   "The print to write; without it, the part's name with .lyr")
        ->option_text("FILE");
    app.add_option("--section-at", arguments.heights_path,
                   "Only cut, at the heights of this file (mm, the model's own coordinates, one a "
                   "line); needs --report")
        ->option_text("FILE");
    app.add_option("--report", arguments.report_path,
                   "Write a line of JSON a section: area, length, loops, lines, arcs, open ends")
        ->option_text("FILE");
}

void add_options(CLI::App& app, Arguments& arguments) {
    slicer::Options& options = arguments.options;
    app.footer(examples);
    app.set_version_flag("--version", "stepc " LYR_VERSION);
    add_files(app, arguments);
    add_number(app, "--layer-height", options.layer_height_mm, 0.001, 10, "MM",
               "Thickness of a layer");
    add_number(app, "--tolerance", options.tolerance.total_mm, 1e-5, 1, "MM",
               "Greatest distance of the printed contour from the exact section");
    app.add_option("--up", arguments.up, "Build direction in the model's coordinates")
        ->delimiter(',')
        ->expected(3)
        ->option_text("X,Y,Z  [0,0,1]");
    app.add_option("--at", arguments.bed_position, "Where on the bed the part's corner lies")
        ->delimiter(',')
        ->expected(2)
        ->option_text("X,Y  [0,0]");
    add_number(app, "--line-width", options.line_width_mm, 0.01, 10, "MM",
               "Width of an extruded line");
    add_number(app, "--wall-speed", options.wall_speed_mm_s, 0.1, 2000, "MM/S",
               "Speed along contours");
    add_number(app, "--infill-speed", options.infill_speed_mm_s, 0.1, 2000, "MM/S",
               "Speed of the fill");
    add_number(app, "--nozzle-temp", options.nozzle_temp_c, 0, 500, "DEG_C",
               "Nozzle temperature; 0: off");
    add_number(app, "--bed-temp", options.bed_temp_c, 0, 200, "DEG_C", "Bed temperature; 0: off");
    app.add_flag("--allow-open", options.allow_open,
                 "Leave out contours that do not close instead of stopping");
    app.add_option("--threads", options.threads,
                   "0: one a processor; the result is the same for any number")
        ->check(CLI::Range(0, 1024))
        ->option_text("N  [0]");
}

// Redrawn at most every tenth of a second, and only where someone can see it.
class ProgressLine {
public:
    void show(const char* stage, std::size_t done, std::size_t total) {
        if (!terminal_) return;
        const auto now = std::chrono::steady_clock::now();
        if (done < total && now - shown_ < std::chrono::milliseconds(100)) return;
        shown_ = now;
        drawn_ = true;
        std::fprintf(stderr, "\r\033[K%s %zu of %zu (%zu %%)", stage, done, total,
                     total ? 100 * done / total : 100);
    }
    void clear() {
        if (drawn_) std::fputs("\r\033[K", stderr);
        drawn_ = false;
    }

private:
    bool terminal_ = ::isatty(STDERR_FILENO) == 1;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point shown_{};
};

int fail(const Diagnostic& diagnostic) {
    std::fprintf(stderr, "stepc: %s\n", to_string(diagnostic).c_str());
    return static_cast<int>(diagnostic.status);
}

int fail_usage(const std::string& message) {
    return fail({Severity::error, ExitStatus::usage, message + " (stepc --help explains)", {}});
}

// A file with ten thousand dirty edges does not need ten thousand lines.
constexpr std::size_t most_shown = 20;

void show(const Diagnostics& diagnostics) {
    for (std::size_t i = 0; i < diagnostics.size() && i < most_shown; ++i) {
        std::fprintf(stderr, "stepc: %s\n", to_string(diagnostics[i]).c_str());
    }
    if (diagnostics.size() > most_shown) {
        std::fprintf(stderr, "stepc: ... and %zu more\n", diagnostics.size() - most_shown);
    }
}

bool is_standard_output(const std::string& path) {
    struct stat named {
    }, standard{};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(STDOUT_FILENO, &standard) == 0 &&
           named.st_dev == standard.st_dev && named.st_ino == standard.st_ino;
}

void show_summary(const Arguments& arguments, const slicer::Summary& summary, std::size_t warnings,
                  double seconds) {
    // A print that goes to standard output must not have text behind it.
    const bool to_pipe = is_standard_output(arguments.heights_path.empty() ? arguments.lyr_path
                                                                           : arguments.report_path);
    std::FILE* out = to_pipe ? stderr : stdout;
    const bool sections = !arguments.heights_path.empty();
    std::fprintf(out, "%s: %zu solid%s, %zu faces\n", arguments.step_path.c_str(), summary.solids,
                 summary.solids == 1 ? "" : "s", summary.faces);
    std::fprintf(out, "%zu %s: %zu contours (%zu full circles), %zu lines, %zu arcs\n",
                 summary.layers, sections ? "sections" : "layers", summary.contours,
                 summary.circles, summary.lines, summary.arcs);
    if (sections) {
        std::fprintf(out, "%s", arguments.report_path.c_str());
    } else {
        const auto size = summary.box.sizes();
        std::fprintf(out, "%.3f x %.3f x %.3f mm at %g mm a layer, tolerance %g mm\n", size.x(),
                     size.y(), size.z(), arguments.options.layer_height_mm,
                     arguments.options.tolerance.total_mm);
        std::fprintf(out, "%s: %llu bytes", arguments.lyr_path.c_str(),
                     static_cast<unsigned long long>(summary.bytes));
    }
    std::fprintf(out, ", %.2f s, %zu warning%s\n", seconds, warnings, warnings == 1 ? "" : "s");
}

Result<slicer::Summary> run(const Arguments& arguments, ProgressLine& line,
                            Diagnostics& diagnostics) {
    const auto progress = [&](const char* stage, std::size_t done, std::size_t total) {
        line.show(stage, done, total);
    };
    std::vector<double> heights;
    if (!arguments.heights_path.empty()) {
        auto read = slicer::read_heights(arguments.heights_path);
        if (!read) return read.error();
        heights = std::move(*read);
    }
    line.show("reading", 0, 1);
    auto model = slicer::load(arguments.step_path, arguments.options, diagnostics);
    if (!model) return model.error();
    if (!arguments.heights_path.empty()) {
        return slicer::section_at(*model, heights, arguments.report_path, arguments.options,
                                  progress, diagnostics);
    }
    const std::string name = std::filesystem::path(arguments.step_path).filename().string();
    return slicer::print(std::move(*model), name, arguments.lyr_path, arguments.report_path,
                         arguments.options, progress, diagnostics);
}

int main_of(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Slices a STEP file into a print of lines and true arcs.", "stepc");
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return fail_usage(error.what());
    }
    arguments.options.up = {arguments.up[0], arguments.up[1], arguments.up[2]};
    arguments.options.bed_position_mm = {arguments.bed_position[0], arguments.bed_position[1]};
    if (!(arguments.options.up.norm() > 0)) return fail_usage("--up must not be 0,0,0");
    if (!arguments.heights_path.empty() && arguments.report_path.empty()) {
        return fail_usage("--section-at needs --report FILE");
    }
    if (!arguments.heights_path.empty() && !arguments.lyr_path.empty()) {
        return fail_usage("--section-at writes no print: leave out -o");
    }
    if (arguments.lyr_path.empty()) {
        arguments.lyr_path = std::filesystem::path(arguments.step_path).replace_extension(".lyr");
    }
    for (const std::string& output : {arguments.lyr_path, arguments.report_path}) {
        std::error_code none;
        if (std::filesystem::equivalent(arguments.step_path, output, none)) {
            return fail_usage("the output would overwrite the part: " + output);
        }
    }
    const auto begin = std::chrono::steady_clock::now();
    ProgressLine line;
    Diagnostics diagnostics;
    const auto summary = run(arguments, line, diagnostics);
    line.clear();
    show(diagnostics);
    if (!summary) return fail(summary.error());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    show_summary(arguments, *summary, diagnostics.size(), seconds.count());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return main_of(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stepc: error: %s\n", error.what());
        return static_cast<int>(ExitStatus::internal);
    }
}
