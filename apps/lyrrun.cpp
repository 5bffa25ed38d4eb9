// lyrrun: prints a .lyr file on the lines of a Linux board, or simulates the print.

#include <cstdio>
#include <string>

#include "apps/command_line.h"
#include "apps/files.h"
#include "apps/printer_file.h"
#include "apps/progress_line.h"
#include "apps/signal_watch.h"
#include "target/run/print.h"
#include "target/run/simulate.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::string lyr_path, printer_path, trace_path;
    bool simulate = false, json = false, no_heat = false;
};

constexpr Program program{
    "lyrrun", "Prints a .lyr file on the lines of a Linux board, or simulates it.",
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
    "What is reported goes to standard error where the trace goes to standard output.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 6 output, 7 the machine cannot\n"
    "or did not do it, 8 stopped on request.\n"};

void add_options(CLI::App& app, Arguments& arguments) {
    add_file(app, "print", arguments.lyr_path,
             "The .lyr file that stepc wrote; it is read more than once, so that it cannot be -, "
             "standard input")
        ->required();
    add_file(app, "--printer", arguments.printer_path,
             "The machine: axes, limits and lines (printer.toml); needed to print; -: standard "
             "input");
    add_flag(app, "--simulate", arguments.simulate,
             "Run without a machine and without waiting; check every pulse against the file");
    add_file(app, "--trace", arguments.trace_path,
             "Write the simulated lines as a wave file (VCD); -: standard output");
    add_flag(app, "--json", arguments.json, "Report the simulation as one JSON object");
    add_flag(app, "--no-heat", arguments.no_heat,
             "Print although the file sets temperatures, which are passed over");
}

// "1:02:03"
std::string clock_text(double time_s) {
    const auto whole_s = static_cast<long long>(time_s);
    char text[40];
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole_s / 3600, whole_s / 60 % 60,
                  whole_s % 60);
    return text;
}

// How far a simulation or print is, as one line.
run::ProgressSink shown_on(ProgressLine& line) {
    return [&line](const run::Progress& progress) {
        std::string text = "layer " + std::to_string(progress.layer) + " of " +
                           std::to_string(progress.layers) + ", " + clock_text(progress.time_s);
        if (progress.estimated_s > 0) text += " of about " + clock_text(progress.estimated_s);
        line.show(text);
    };
}

Status simulate(const Arguments& arguments, const config::Printer& printer) {
    const SignalWatch watch(program.name);
    ProgressLine line;
    run::SimulationJob job{arguments.lyr_path, printer, {}, shown_on(line), {}};
    if (!arguments.trace_path.empty()) job.trace = arguments.trace_path;
    const Result<run::SimulationReport> report = run::simulate(job);
    line.clear();
    if (!report) return report.error();
    show(program, report->notes);
    const std::string text = arguments.json ? run::json_of(*report) : run::text_of(*report);
    if (const Status told = tell(text, {{"the trace", arguments.trace_path}}); !told) return told;
    if (report->within_limits()) return Done{};
    return Diagnostic{Severity::error,
                      ExitStatus::machine,
                      "the pulses leave the file's path by more than half a microstep, or are "
                      "shorter than the drivers need",
                      {.file = arguments.lyr_path}};
}

Status print(const Arguments& arguments, const config::Printer& printer) {
    ProgressLine line;
    const run::PrintJob job{arguments.lyr_path, printer, arguments.no_heat, shown_on(line)};
    const Result<run::PrintReport> report = run::print(job);
    line.clear();
    if (!report) return report.error();
    show(program, report->warnings);
    return tell(arguments.lyr_path + " printed on \"" + printer.name + "\"\n" +
                run::text_of(*report));
}

Status work(const Arguments& arguments) {
    // The whole file is checked before the first motion, and then read again.
    if (arguments.lyr_path == "-")
        return usage("a print is read more than once: give a file, not standard input");
    if (!arguments.simulate && arguments.printer_path.empty())
        return usage("to print, --printer FILE must say what the machine is");
    if (!arguments.simulate && (!arguments.trace_path.empty() || arguments.json))
        return usage("--trace and --json need --simulate");
    if (const Status apart = check_apart(
            {{"the print", arguments.lyr_path}, {"the printer's file", arguments.printer_path}},
            {{"the trace", arguments.trace_path}});
        !apart)
        return apart;
    const Result<config::Printer> printer = read_printer(arguments.printer_path);
    if (!printer) return printer.error();
    return arguments.simulate ? simulate(arguments, *printer) : print(arguments, *printer);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](CLI::App& app) { add_options(app, arguments); },
        [&](const CLI::App&) { return work(arguments); });
}
