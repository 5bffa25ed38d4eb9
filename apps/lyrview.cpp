// lyrview: shows what a .lyr file will print, as a picture of a layer or in figures.

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

#include "base/diagnostic.h"
#include "base/replace_file.h"
#include "format/export/statistics.h"
#include "format/export/svg.h"
#include "format/reader.h"

namespace {

using namespace lyr;

struct Arguments {
    std::string lyr_path, output_path;
    std::uint32_t layer = 0;  // from 1
    bool info = false, no_travel = false;
};

constexpr const char* examples =
    "Examples:\n"
    "  lyrview part.lyr --info                               what is in it, lengths, estimates\n"
    "  lyrview part.lyr --layer 36 -o layer.svg              layer 36 as a picture, in mm\n"
    "  lyrview part.lyr --layer 36 --no-travel -o layer.svg  only what is extruded\n"
    "  stepc part.step -o /dev/stdout | lyrview - --info     from a pipe\n"
    "\n"
    "Layers count from 1, the one on the bed. In the picture arcs are arcs at any zoom, strokes\n"
    "are as wide as the extrusion, and travels are thin and dashed. --info reads the whole file "
    "and\n"
    "says so if a part is damaged.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 a newer file format, 6 output.\n";

void add_options(CLI::App& app, Arguments& arguments) {
    app.footer(examples);
    app.set_version_flag("--version", "lyrview " LYR_VERSION);
    app.add_option("print", arguments.lyr_path, "The .lyr file that stepc wrote; -: standard input")
        ->type_name("FILE")
        ->required();
    app.add_flag("--info", arguments.info, "Sum the file up on standard output");
    app.add_option("--layer", arguments.layer, "Draw this layer, 1 to the number of layers")
        ->type_name("N");
    app.add_option("-o,--output", arguments.output_path,
                   "The picture to write (SVG); without it, or as -: standard output")
        ->type_name("FILE");
    app.add_flag("--no-travel", arguments.no_travel, "Leave out the ways without extrusion");
}

int fail(const Diagnostic& diagnostic) {
    std::fprintf(stderr, "lyrview: %s\n", to_string(diagnostic).c_str());
    return static_cast<int>(diagnostic.status);
}

int fail_usage(const std::string& message) {
    return fail({Severity::error, ExitStatus::usage, message + " (lyrview --help explains)", {}});
}

Status print(const std::string& text) {
    errno = 0;
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
        return Done{};
    return Diagnostic{Severity::error,
                      ExitStatus::output,
                      std::string("cannot write: ") + std::strerror(errno ? errno : EIO),
                      {.file = "standard output"}};
}

Status draw_layer(const Arguments& arguments) {
    auto reader = format::Reader::open(arguments.lyr_path,
                                       {.keep_thumbnails = false, .keep_configuration = false});
    if (!reader) return reader.error();
    const auto svg =
        format::layer_svg(*reader, arguments.layer - 1, {.travels = !arguments.no_travel});
    if (!svg) return svg.error();
    if (arguments.output_path.empty() || arguments.output_path == "-") return print(*svg);
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
    return print(format::to_text(*statistics, arguments.lyr_path));
}

int main_of(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Shows what a .lyr file will print.", "lyrview");
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return fail_usage(error.what());
    }
    const bool draws = app.count("--layer") > 0;
    if (draws == arguments.info) return fail_usage("say either --info or --layer N");
    if (draws && arguments.layer == 0)
        return fail_usage("there is no layer 0: the one on the bed is layer 1");
    if (!draws && (!arguments.output_path.empty() || arguments.no_travel))
        return fail_usage("-o and --no-travel need --layer N");
    std::error_code none;
    if (std::filesystem::equivalent(arguments.lyr_path, arguments.output_path, none))
        return fail_usage("the picture would replace the print: give -o another name");
    const Status done = draws ? draw_layer(arguments) : show_info(arguments);
    return done ? static_cast<int>(ExitStatus::ok) : fail(done.error());
}

}  // namespace

int main(int argc, char** argv) {
    // Nothing of this project throws; what the standard library throws (no memory) ends here.
    try {
        return main_of(argc, argv);
    } catch (const std::exception& error) {
        return fail({Severity::error, ExitStatus::internal, error.what(), {}});
    }
}
