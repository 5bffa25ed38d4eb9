// lyrrun: prints a .lyr file on the lines of a Linux board, or simulates the print.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>

#include "base/diagnostic.h"
#include "target/config/printer.h"
#include "target/run/print.h"
#include "target/run/simulate.h"
#include "target/run/stop_signals.h"

namespace {

using namespace lyr;

struct Arguments {
    std::string lyr_path, printer_path, trace_path;
    bool simulate = false, json = false, no_heat = false;
};

constexpr const char* examples =
    "Examples:\n"
    "  lyrrun part.lyr --simulate                         the print on a generic printer, without "
    "one\n"
    "  lyrrun part.lyr --simulate --printer printer.toml  on your own\n"
    "  lyrrun part.lyr --simulate --trace part.vcd        every edge of every line, for GTKWave\n"
    "  lyrrun part.lyr --printer printer.toml --no-heat   move the machine, heaters off\n"
    "\n"
    "A print takes the whole path from the file and starts with the head at start_mm of the\n"
    "printer. Ctrl-C brings the head to rest on its path and releases all lines; a second\n"
    "Ctrl-C does so at once. docs/configuration.md explains printer.toml.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 6 output, 7 the machine cannot\n"
    "or did not do it, 8 stopped on request.\n";

void add_options(CLI::App& app, Arguments& arguments) {
    app.footer(examples);
    app.set_version_flag("--version", "lyrrun " LYR_VERSION);
    app.add_option("print", arguments.lyr_path, "The .lyr file that stepc wrote")->required();
    app.add_option("--printer", arguments.printer_path,
                   "The machine: axes, limits and lines (printer.toml); needed to print");
    app.add_flag("--simulate", arguments.simulate,
                 "Run without a machine and without waiting; check every pulse against the file");
    app.add_option("--trace", arguments.trace_path,
                   "Write the simulated lines as a wave file (VCD)");
    app.add_flag("--json", arguments.json, "Report the simulation as one JSON object");
    app.add_flag("--no-heat", arguments.no_heat,
                 "Print although the file sets temperatures, which are passed over");
}

// Redrawn at most every tenth of a second, and only where someone can see it.
class ProgressLine {
public:
    void show(const run::Progress& progress) {
        if (!terminal_) return;
        const auto now = std::chrono::steady_clock::now();
        if (now - shown_ < std::chrono::milliseconds(100)) return;
        shown_ = now;
        drawn_ = true;
        const auto time_s = static_cast<long long>(progress.time_s);
        std::fprintf(stderr, "\r\033[Klayer %u of %u, %lld:%02lld:%02lld", progress.layer,
                     progress.layers, time_s / 3600, time_s / 60 % 60, time_s % 60);
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
    std::fprintf(stderr, "lyrrun: %s\n", to_string(diagnostic).c_str());
    return static_cast<int>(diagnostic.status);
}

int fail_usage(const std::string& message) {
    return fail({Severity::error, ExitStatus::usage, message + " (lyrrun --help explains)", {}});
}

void show(const Diagnostics& diagnostics) {
    for (const Diagnostic& diagnostic : diagnostics)
        std::fprintf(stderr, "lyrrun: %s\n", to_string(diagnostic).c_str());
}

int simulate(const Arguments& arguments, const config::Printer& printer, ProgressLine& line) {
    const run::StopSignals signals;
    run::SimulationJob job{arguments.lyr_path, printer, {}, {}, {}};
    if (!arguments.trace_path.empty()) job.trace = arguments.trace_path;
    job.progress = [&](const run::Progress& progress) { line.show(progress); };
    job.stop = [&] { return signals.wait_ms(0); };
    const Result<run::SimulationReport> report = run::simulate(job);
    line.clear();
    if (!report) return fail(report.error());
    show(report->notes);
    const std::string text = arguments.json ? run::json_of(*report) : run::text_of(*report);
    std::fputs(text.c_str(), stdout);
    if (report->within_limits()) return static_cast<int>(ExitStatus::ok);
    return fail({Severity::error,
                 ExitStatus::machine,
                 "the pulses leave the file's path by more than half a microstep, or are shorter "
                 "than the drivers need",
                 {.file = arguments.lyr_path}});
}

int print(const Arguments& arguments, const config::Printer& printer, ProgressLine& line) {
    run::PrintJob job{arguments.lyr_path, printer, arguments.no_heat, {}};
    job.progress = [&](const run::Progress& progress) { line.show(progress); };
    const Result<run::PrintReport> report = run::print(job);
    line.clear();
    if (!report) return fail(report.error());
    show(report->warnings);
    std::printf("%s printed on \"%s\"\n%s", arguments.lyr_path.c_str(), printer.name.c_str(),
                run::text_of(*report).c_str());
    return static_cast<int>(ExitStatus::ok);
}

int main_of(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("Prints a .lyr file on the lines of a Linux board, or simulates it.", "lyrrun");
    add_options(app, arguments);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return fail_usage(error.what());
    }
    // The whole file is checked before the first motion, and then read again.
    if (arguments.lyr_path == "-")
        return fail_usage("a print is read more than once: give a file, not standard input");
    if (!arguments.simulate && arguments.printer_path.empty())
        return fail_usage("to print, --printer FILE must say what the machine is");
    if (!arguments.simulate && (!arguments.trace_path.empty() || arguments.json))
        return fail_usage("--trace and --json need --simulate");
    Result<config::Printer> printer = arguments.printer_path.empty()
                                          ? Result(config::generic_printer())
                                          : config::read_printer(arguments.printer_path);
    if (!printer) return fail(printer.error());
    ProgressLine line;
    return arguments.simulate ? simulate(arguments, *printer, line)
                              : print(arguments, *printer, line);
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
