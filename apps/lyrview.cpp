// lyrview: shows what a .lyr file will print, as a picture of a layer or in figures.

#include <limits>
#include <string>

#include "apps/command_line.h"
#include "apps/files.h"
#include "apps/print_checks.h"
#include "apps/signal_watch.h"
#include "base/replace_file.h"
#include "format/export/statistics.h"
#include "format/export/svg.h"
#include "format/reader.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::string lyr_path, output_path = "-";
    std::uint32_t layer = 0;  // from 1; 0: not given
    bool info = false, no_travel = false;
    CheckRequest checks;
};

constexpr Program program{
    "lyrview", "Shows what a .lyr file will print.",
    "Examples:\n"
    "  lyrview part.lyr --info                               what is in it, lengths, estimates\n"
    "  lyrview part.lyr --layer 36 -o layer.svg              layer 36 as a picture, in mm\n"
    "  lyrview part.lyr --layer 36 --no-travel -o layer.svg  only what is extruded\n"
    "  lyrview part.lyr --verify                             is it whole? What is damaged, where?\n"
    "  lyrview broken.lyr --repair -o whole.lyr              the layers in front of the damage\n"
    "  lyrview part.lyr --thumbnail -o part.png              the print's own small picture\n"
    "  lyrview --diff old.lyr new.lyr                        how the second differs from the "
    "first\n"
    "  stepc part.step -o - | lyrview - --info               from a pipe\n"
    "\n"
    "Layers count from 1, the one on the bed. In the picture arcs are arcs at any zoom, strokes\n"
    "are as wide as the extrusion, and travels are thin and dashed. --info reads the whole file "
    "and\n"
    "says so if a part is damaged.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 a newer file format, 6 output, 8 stopped on "
    "request,\n"
    "9 the prints of --diff differ.\n"};

void add_options(CLI::App& app, Arguments& arguments) {
    add_file(app, "print", arguments.lyr_path, "The .lyr file that stepc wrote; -: standard input")
        ->required();
    add_flag(app, "--info", arguments.info, "Sum the file up on standard output");
    add_count(app, "--layer", "N", arguments.layer, {1, std::numeric_limits<std::uint32_t>::max()},
              "Draw this layer, 1 to the number of layers");
    add_file(app, "-o,--output", arguments.output_path,
             "The picture to write (SVG); without it, or as -: standard output");
    add_flag(app, "--no-travel", arguments.no_travel, "Leave out the ways without extrusion");
    add_checks(app, arguments.checks);
}

Status draw_layer(const Arguments& arguments) {
    auto reader = format::Reader::open(arguments.lyr_path,
                                       {.keep_thumbnails = false, .keep_configuration = false});
    if (!reader) return reader.error();
    const auto svg =
        format::layer_svg(*reader, arguments.layer - 1, {.travels = !arguments.no_travel});
    if (!svg) return svg.error();
    auto file = ReplaceFile::open(arguments.output_path);
    if (!file) return file.error();
    file->write(*svg);
    return file->commit();
}

Status show_info(const Arguments& arguments) {
    auto reader = format::Reader::open(arguments.lyr_path);
    if (!reader) return reader.error();
    const auto statistics = format::statistics_of(*reader);
    if (!statistics) return statistics.error();
    return tell(format::to_text(*statistics, input_name(arguments.lyr_path)));
}

Status work(const CLI::App& app, const Arguments& arguments) {
    if (arguments.checks.any())
        return check_print(app, program, arguments.checks, arguments.lyr_path,
                           arguments.output_path,
                           arguments.layer > 0 || arguments.info || arguments.no_travel);
    const bool draws = arguments.layer > 0;
    if (draws == arguments.info) return usage("say either --info or --layer N");
    if (!draws && (app.count("--output") > 0 || arguments.no_travel))
        return usage("-o and --no-travel need --layer N");
    if (const Status apart = check_apart({{"the print", arguments.lyr_path}},
                                         {{"the picture", arguments.output_path}});
        !apart)
        return apart;
    const SignalWatch watch(program.name);
    return draws ? draw_layer(arguments) : show_info(arguments);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](CLI::App& app) { add_options(app, arguments); },
        [&](const CLI::App& app) { return work(app, arguments); });
}
