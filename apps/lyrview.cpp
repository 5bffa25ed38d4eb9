// lyrview: shows what a .lyr file will print, checks it, and writes it as other programs want it.

#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "apps/command_line.h"
#include "apps/export_format.h"
#include "apps/files.h"
#include "apps/gcode_to_print.h"
#include "apps/print_checks.h"
#include "apps/signal_watch.h"
#include "format/export/statistics.h"
#include "format/export/viewer/viewer_page.h"
#include "format/reader.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::string lyr_path, gcode_path, output_path = "-", to;
    std::array<double, 1> filament_mm{};  // diameter; 0: not given
    std::uint32_t layer = 0;              // from 1; 0: not given
    bool all_layers = false, info = false, no_travel = false;
    GcodeRequest gcode;
    CheckRequest checks;

    std::vector<NamedFile> inputs() const {
        return {{"the print", lyr_path},
                {"the G-code", gcode_path},
                {"the lines before the print", gcode.start_path},
                {"the lines after the print", gcode.end_path}};
    }
};

constexpr Program program{
    "lyrview", "Shows what a .lyr file will print.",
    "Examples:\n"
    "  lyrview part.lyr -o part.html                         a page that shows it, in any browser\n"
    "  lyrview part.lyr --info                               what is in it, lengths, estimates\n"
    "  lyrview part.lyr --layer 36 -o layer.svg              layer 36 as a picture, in mm\n"
    "  lyrview part.lyr --layer 36 --no-travel -o layer.svg  only what is extruded\n"
    "  lyrview part.lyr --layer 36 -o layer.dxf              for CAD, arcs as arcs\n"
    "  lyrview part.lyr -o part.cli                          for other machines; or part.3mf\n"
    "  lyrview part.lyr -o part.gcode --gcode-flavor klipper as G-code, arcs as G2 and G3\n"
    "  lyrview --from-gcode part.gcode -o part.lyr           what another slicer made, for lyrrun\n"
    "  lyrview part.lyr --verify                             is it whole? What is damaged, where?\n"
    "  lyrview broken.lyr --repair -o whole.lyr              the layers in front of the damage\n"
    "  lyrview part.lyr --thumbnail -o part.png              the print's own small picture\n"
    "  lyrview --diff old.lyr new.lyr                        how the second differs from the "
    "first\n"
    "  stepc part.step -o - | lyrview - --info               from a pipe\n"
    "\n"
    "What is written follows from the ending of the file's name, or from --to.\n"
    "Layers count from 1, the one on the bed. In the picture arcs are arcs at any zoom, strokes\n"
    "are as wide as the extrusion, and travels are thin and dashed. --info reads the whole file "
    "and\n"
    "says so if a part is damaged.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 a newer file format, 6 output, 8 stopped on "
    "request,\n"
    "9 the prints of --diff differ.\n"};

void add_gcode(Options& app, GcodeRequest& gcode) {
    const auto into = [](std::string& value, const char* choices) {
        return [&value, choices](const std::string& text) {
            value = text;
            return text.empty() ? std::optional<std::string>(choices) : std::nullopt;
        };
    };
    add_text(app, "--gcode-flavor", "marlin|klipper", into(gcode.flavor, "marlin or klipper"),
             "G-code for this firmware, whatever the print's gcode.flavor says");
    add_text(
        app, "--gcode-e", "relative|absolute", into(gcode.extrusion, "relative or absolute"),
        "Filament counted anew in each move or from the layer's start; otherwise as the print's "
        "gcode.extrusion says");
    add_file(app, "--gcode-start", gcode.start_path,
             "Lines to begin the G-code with, instead of the print's gcode.start; docs/exports.md "
             "has their {placeholders}");
    add_file(app, "--gcode-end", gcode.end_path,
             "Lines to end it with, instead of the print's gcode.end");
}

void add_options(Options& app, Arguments& arguments) {
    add_file(app, "print", arguments.lyr_path, "The .lyr file that stepc wrote; -: standard input");
    add_file(app, "--from-gcode", arguments.gcode_path,
             "Instead of a print: G-code of any slicer, to write as a print (-o FILE.lyr); -: "
             "standard input");
    add_numbers(app, "--filament-diameter", "MM", arguments.filament_mm, {0, 10, "mm"},
                "Of the G-code's filament; 0: as its comments say, or 1.75");
    add_flag(app, "--info", arguments.info, "Sum the file up on standard output");
    add_text(
        app, "--layer", "N|all",
        [&](const std::string& text) -> std::optional<std::string> {
            arguments.all_layers = text == "all";
            if (arguments.all_layers) return std::nullopt;
            const auto [end, error] =
                std::from_chars(text.data(), text.data() + text.size(), arguments.layer);
            const bool is_number = error == std::errc() && end == text.data() + text.size();
            if (is_number && arguments.layer > 0) return std::nullopt;
            arguments.layer = 0;
            return "a whole number from 1 to " +
                   std::to_string(std::numeric_limits<std::uint32_t>::max()) + ", or all";
        },
        "Draw this layer, 1 to the number of layers, or all of them in one file (SVG, DXF)");
    add_file(app, "-o,--output", arguments.output_path,
             "What to write; without it, or as -: standard output");
    add_text(
        app, "--to", "FORMAT",
        [&](const std::string& text) {
            arguments.to = text;
            return std::optional<std::string>();
        },
        "What to write, whatever the file's name: " + export_format_names());
    add_flag(app, "--no-travel", arguments.no_travel, "Leave out the ways without extrusion");
    add_gcode(app, arguments.gcode);
    add_checks(app, arguments.checks);
}

Status write(const Arguments& arguments, ExportFormat format) {
    const bool is_gcode = format == ExportFormat::gcode;
    auto reader = format::Reader::open(
        arguments.lyr_path, {.keep_thumbnails = is_gcode, .keep_configuration = is_gcode});
    if (!reader) return reader.error();
    ExportRequest request{
        .format = format, .travels = !arguments.no_travel, .gcode = arguments.gcode};
    if (arguments.layer > 0) request.layer = arguments.layer - 1;
    auto file = ReplaceFile::open(arguments.output_path);
    if (!file) return file.error();
    Diagnostics diagnostics;
    const auto written = export_print(*reader, request, std::move(*file), diagnostics);
    show(program, diagnostics);
    if (!written) return written.error();
    return Done{};
}

Status write_page(const Arguments& arguments) {
    auto file = ReplaceFile::open(arguments.output_path);
    if (!file) return file.error();
    const Status written = format::write_viewer(
        arguments.lyr_path, [&](std::string_view piece) { file->write(piece); });
    return written ? file->commit() : written;
}

Status show_info(const Arguments& arguments) {
    auto reader = format::Reader::open(arguments.lyr_path);
    if (!reader) return reader.error();
    const auto statistics = format::statistics_of(*reader);
    if (!statistics) return statistics.error();
    return tell(format::to_text(*statistics, input_name(arguments.lyr_path)));
}

// Whether anything is said that --verify, --repair and --diff have no use for.
bool is_asked_more(const Arguments& arguments) {
    return arguments.layer > 0 || arguments.all_layers || arguments.info || arguments.no_travel ||
           !arguments.gcode_path.empty() || !arguments.to.empty() || arguments.gcode.any();
}

// Which options go together.
Status check(const Options& app, const Arguments& arguments, std::optional<ExportFormat> format) {
    const bool draws = arguments.layer > 0 || arguments.all_layers;
    const bool is_picture = format && is_drawing(*format);
    const char* what = draws                          ? "the picture"
                       : format == ExportFormat::page ? "the page"
                                                      : "the export";
    const NamedFile output{what, arguments.output_path};
    if (const Status apart = check_apart(arguments.inputs(), {output}); !apart) return apart;
    if (arguments.info && (draws || app.count("--output") > 0 || !arguments.to.empty()))
        return usage("--info writes nothing else: say either --info or --layer N or -o FILE");
    if (is_picture && !draws) return usage("a picture needs --layer N, or --layer all");
    if (format && !is_picture && draws) return usage("--layer N makes pictures only");
    if (arguments.no_travel && !is_picture) return usage("--no-travel needs --layer N");
    if (arguments.gcode.any() && format != ExportFormat::gcode)
        return usage("--gcode-... need G-code to write: -o FILE.gcode or --to gcode");
    return Done{};
}

// From G-code to a print.
Status bring_in(const Options& app, const Arguments& arguments) {
    std::string ending = std::filesystem::path(arguments.output_path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool is_print = arguments.to.empty() ? ending == ".lyr" || arguments.output_path == "-"
                                               : arguments.to == "lyr";
    if (!arguments.lyr_path.empty() || arguments.info || arguments.layer > 0 ||
        arguments.all_layers || arguments.no_travel || arguments.gcode.any() ||
        app.count("--output") == 0 || !is_print)
        return usage("--from-gcode writes a print and nothing else: say -o FILE.lyr");
    const NamedFile output{"the print", arguments.output_path};
    if (const Status apart = check_apart({{"the G-code", arguments.gcode_path}}, {output}); !apart)
        return apart;
    const SignalWatch watch(program.name);
    Diagnostics diagnostics;
    const auto text = gcode_to_print(arguments.gcode_path, arguments.output_path,
                                     arguments.filament_mm[0], diagnostics);
    show(program, diagnostics);
    if (!text) return text.error();
    return tell(*text, {output});
}

Status work(const Options& app, const Arguments& arguments) {
    if (arguments.lyr_path.empty() && arguments.gcode_path.empty())
        return usage("print is required");
    if (arguments.gcode_path.empty() && app.count("--filament-diameter") > 0)
        return usage("--filament-diameter needs --from-gcode: a print states its own");
    if (arguments.checks.any())
        return check_print(app, program, arguments.checks, arguments.lyr_path,
                           arguments.output_path, is_asked_more(arguments));
    if (!arguments.gcode_path.empty()) return bring_in(app, arguments);
    std::optional<ExportFormat> format;
    if (!arguments.info) {
        const bool draws = arguments.layer > 0 || arguments.all_layers;
        if (!draws && app.count("--output") == 0 && arguments.to.empty())
            return usage(
                "say what of it to show: --info, --layer N, or a file to write, as -o part.html");
        // A name that says png or pdf is not given a picture of another kind.
        const bool says_none = std::filesystem::path(arguments.output_path).extension().empty();
        const auto otherwise = draws && says_none ? std::optional(ExportFormat::svg) : std::nullopt;
        const auto found = export_format(arguments.output_path, arguments.to, otherwise);
        if (!found) return found.error();
        format = *found;
    }
    if (const Status checked = check(app, arguments, format); !checked) return checked;
    const SignalWatch watch(program.name);
    if (!format) return show_info(arguments);
    return format == ExportFormat::page ? write_page(arguments) : write(arguments, *format);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](Options& app) { add_options(app, arguments); },
        [&](const Options& app) { return work(app, arguments); });
}
