// stepc: slices a STEP file into a .lyr print, or reports sections at given heights.

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line.h"
#include "apps/export_format.h"
#include "apps/files.h"
#include "apps/printer_file.h"
#include "apps/progress_line.h"
#include "apps/signal_watch.h"
#include "apps/unnamed_print.h"
#include "base/read_text.h"
#include "base/text.h"
#include "profile/built_in.h"
#include "profile/resolve.h"
#include "slicer/slicer.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    // The output is a .lyr file, or what else its name or --to says.
    std::string step_path, output_path, to, heights_path, report_path, printer_path;
    ExportFormat format = ExportFormat::lyr;
    std::array<double, 3> up{0, 0, 1};
    profile::Request settings;
    bool print_config = false;
    slicer::Options options;

    bool sections() const { return !heights_path.empty(); }
    // A profile that is no stream is looked for by its name; which files are read shows then.
    std::vector<NamedFile> inputs() const {
        return {{"the part", step_path},
                {"the heights", heights_path},
                {"the profile", settings.profile == "-" ? "-" : ""},
                {"the printer's file", printer_path}};
    }
    std::vector<NamedFile> outputs() const {
        return {{"the print", output_path}, {"the report", report_path}};
    }
};

constexpr Program program{
    "stepc", "Slices a STEP file into a print of lines and true arcs.",
    "Examples:\n"
    "  stepc part.step -o part.lyr                        slice at 0.2 mm\n"
    "  stepc part.step -o part.lyr --layer-height 0.1     finer\n"
    "  stepc part.step -o part.lyr --cusp 0.02            finer where the surface is flat\n"
    "  stepc part.step --profile petg --set perimeters.count=4   another material, more walls\n"
    "  stepc --profile petg --print-config                all settings, and where they come from\n"
    "  stepc part.step -o part.lyr --printer printer.toml     how long it takes on your own\n"
    "  stepc part.step -o part.lyr --up 0,-1,0            print it lying on another side\n"
    "  stepc part.step --section-at z.txt --report s.jsonl   areas at heights of your own\n"
    "  stepc part.step -o part.gcode --set gcode.flavor=klipper   for another firmware\n"
    "  stepc part.step -o - | lyrview - --info            into a pipe\n"
    "\n"
    "Layer i is the section at its middle, with equal layers (i - 1/2) x layer height over the "
    "bed\n"
    "or the raft; there are as many layers as have their middle below the part's top. Adaptive\n"
    "layers end on level faces instead.\n"
    "The summary goes to standard error where the print or the report goes to standard output.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 5 geometry, 6 output, 7 the "
    "printer\n"
    "cannot do it, 8 stopped on request.\n"};

// Only the direction counts; no vector that means one is longer.
constexpr NumberRange direction{-1'000, 1'000, ""};

void add_files(Options& app, Arguments& arguments) {
    add_file(app, "part", arguments.step_path,
             "STEP file (ISO 10303-21; AP203, AP214, AP242); -: standard input");
    add_file(app, "-o,--output", arguments.output_path,
             "The print to write, as .lyr or as the name's ending says (.gcode); -: standard "
             "output; without it, the part's name with .lyr");
    add_text(
        app, "--to", "FORMAT",
        [&](const std::string& text) {
            arguments.to = text;
            return std::optional<std::string>();
        },
        "What to write, whatever the output's name: " + export_format_names());
    add_file(app, "--section-at", arguments.heights_path,
             "Only cut, at the heights of this file (mm, the model's own coordinates, one a line); "
             "-: standard input; needs --report");
    add_file(app, "--report", arguments.report_path,
             "Write a line of JSON a section: area, length, loops, lines, arcs, open ends; -: "
             "standard output");
}

// An option that is short for --set of one key. The key's own rules say what it takes.
void add_shorthand(Options& app, Arguments& arguments, const std::string& option, const char* shape,
                   const std::string& key, const std::string& text) {
    const auto take = [&arguments, option, key](const std::string& value) {
        arguments.settings.settings.push_back({key, value, option});
        return std::optional<std::string>();
    };
    add_text(app, option, shape, take, text + "; short for --set " + key + "=" + shape);
}

// How fine adaptive layers are, which it asks for.
void add_cusp(Options& app, Arguments& arguments) {
    const auto take = [&arguments](const std::string& value) {
        arguments.settings.settings.push_back({"layer.adaptive", "true", "--cusp"});
        arguments.settings.settings.push_back({"layer.cusp", value, "--cusp"});
        return std::optional<std::string>();
    };
    add_text(
        app, "--cusp", "MM", take,
        "Layers as thick as steps of this depth allow; short for --set layer.adaptive=true --set "
        "layer.cusp=MM");
}

void add_settings(Options& app, Arguments& arguments) {
    std::string built_in;
    for (const std::string& name : profile::built_in_names())
        built_in += (built_in.empty() ? "" : ", ") + name;
    add_file(app, "--profile", arguments.settings.profile,
             "Settings of a material: a TOML file or a built-in profile (" + built_in +
                 "); -: standard input");
    const auto take = [&arguments](const std::string& text) -> std::optional<std::string> {
        auto setting = profile::parse_setting(text, "--set");
        if (!setting) return "KEY=VALUE";
        arguments.settings.settings.push_back(std::move(*setting));
        return std::nullopt;
    };
    add_texts(app, "--set", "KEY=VALUE ...", take,
              "A setting, whatever the profile says; may be given any number of times");
    add_flag(app, "--print-config", arguments.print_config,
             "Show all settings with their origins, as a profile, and do no more");
    add_shorthand(app, arguments, "--layer-height", "MM", "layer.height", "Thickness of a layer");
    add_cusp(app, arguments);
    add_shorthand(app, arguments, "--tolerance", "MM", "slicing.tolerance",
                  "Greatest distance of the printed contour from the exact section");
    add_shorthand(app, arguments, "--at", "X,Y", "plate.at",
                  "Where on the bed the part's corner lies");
}

void add_options(Options& app, Arguments& arguments) {
    slicer::Options& options = arguments.options;
    add_files(app, arguments);
    add_settings(app, arguments);
    add_file(
        app, "--printer", arguments.printer_path,
        "The machine whose limits the time is estimated with, and whose ranges the print should "
        "keep to (printer.toml); -: standard input; without it, a generic one");
    add_numbers(app, "--up", "X,Y,Z", arguments.up, direction,
                "Build direction in the model's coordinates, of any length");
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
    if (summary.uncrossed_layers > 0)
        text += "the section crosses itself in " + counted(summary.uncrossed_layers, "layer") +
                "; what it winds around is printed\n";
    char line[160];
    if (arguments.sections()) {
        text += output_name(arguments.report_path);
    } else {
        text += slicer::size_text(summary, arguments.options) + summary.placed +
                slicer::estimate_text(summary, arguments.options.machine().name) +
                output_name(arguments.output_path) + ": " + counted(summary.bytes, "byte");
    }
    std::snprintf(line, sizeof line, ", %.2f s, ", time_s);
    return text + line + counted(findings, "finding") + '\n';
}

// The print, by way of a .lyr file if it is to be something else.
Result<slicer::Summary> print(Model model, const Arguments& arguments,
                              const slicer::Options& options, const slicer::Progress& progress,
                              Diagnostics& diagnostics) {
    const std::string name = arguments.step_path == "-"
                                 ? standard_input_name
                                 : std::filesystem::path(arguments.step_path).filename().string();
    const auto print_to = [&](const std::string& path) {
        return slicer::print(std::move(model), name, path, arguments.report_path, options, progress,
                             diagnostics);
    };
    if (arguments.format == ExportFormat::lyr) return print_to(arguments.output_path);
    auto file = ReplaceFile::open(arguments.output_path);
    if (!file) return file.error();
    auto unnamed = UnnamedPrint::create();
    if (!unnamed) return unnamed.error();
    auto summary = print_to(unnamed->path());
    if (!summary) return summary.error();
    auto reader = unnamed->read();
    if (!reader) return reader.error();
    const auto bytes =
        export_print(*reader, {.format = arguments.format}, std::move(*file), diagnostics);
    if (!bytes) return bytes.error();
    summary->bytes = *bytes;
    return summary;
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
    slicer::Options options = arguments.options;
    auto model = slicer::load(arguments.step_path, options, diagnostics, &options.source_sha256);
    if (!model) return model.error();
    if (arguments.sections()) {
        return slicer::section_at(*model, heights, arguments.report_path, arguments.options,
                                  progress, diagnostics);
    }
    return print(std::move(*model), arguments, options, progress, diagnostics);
}

// What the options say together, and the name of the print where they do not say it.
Status complete(Arguments& arguments) {
    const Vector3 up(arguments.up.data());
    const double longest = up.cwiseAbs().maxCoeff();
    if (arguments.step_path.empty()) return usage("part is required");
    if (!(longest > 0)) return usage("--up: 0,0,0 is no direction");
    arguments.options.up = up / longest;  // so that no square of a component underflows
    if (arguments.sections() && arguments.report_path.empty())
        return usage("--section-at needs --report FILE");
    if (arguments.sections() && !(arguments.output_path.empty() && arguments.to.empty()))
        return usage("--section-at writes no print: leave out -o");
    if (arguments.sections() && !arguments.printer_path.empty())
        return usage("--section-at estimates no time: leave out --printer");
    if (!arguments.sections() && arguments.output_path.empty()) {
        if (arguments.step_path == "-") return usage("a part from standard input needs -o FILE");
        if (!arguments.to.empty()) return usage("--to needs -o FILE");
        arguments.output_path =
            std::filesystem::path(arguments.step_path).replace_extension(".lyr");
    }
    const auto format = export_format(arguments.output_path, arguments.to, ExportFormat::lyr);
    if (!format) return format.error();
    if (is_drawing(*format)) return usage("stepc draws no layers: lyrview does, of a .lyr file");
    arguments.format = *format;
    return check_apart(arguments.inputs(), arguments.outputs());
}

Status take_settings(Arguments& arguments, const profile::Resolved& settings) {
    for (const std::string& file : settings.files)
        if (const Status apart = check_apart({{"the profile", file}}, arguments.outputs()); !apart)
            return apart;
    arguments.options.profile = settings.profile;
    arguments.options.profile_name = settings.name;
    arguments.options.configuration = to_toml(settings, profile::Folders::left_out);
    return Done{};
}

Status work(Arguments& arguments) {
    if (!arguments.print_config)
        if (const Status completed = complete(arguments); !completed) return completed;
    const auto settings = profile::resolve(arguments.settings);
    if (!settings) return settings.error();
    if (arguments.print_config) return tell(to_toml(*settings));
    if (const Status taken = take_settings(arguments, *settings); !taken) return taken;
    const auto printer = read_printer(arguments.printer_path);
    if (!printer) return printer.error();
    arguments.options.printer = *printer;
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
        program, argc, argv, [&](Options& app) { add_options(app, arguments); },
        [&](const Options&) { return work(arguments); });
}
