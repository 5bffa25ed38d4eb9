// lyrrun: prints a .lyr file on the lines of a Linux board, or simulates the print.

#include <algorithm>
#include <cstdio>
#include <string>

#include "apps/command_line.h"
#include "apps/files.h"
#include "apps/lyrrun_board.h"
#include "apps/lyrrun_place.h"
#include "apps/print_server.h"
#include "apps/printer_file.h"
#include "apps/progress_line.h"
#include "apps/signal_watch.h"
#include "base/read_text.h"
#include "base/text.h"
#include "target/run/dry_run.h"
#include "target/run/print.h"
#include "target/run/resumption.h"
#include "target/run/simulate.h"
#include "target/run/tune.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::string lyr_path, printer_path, trace_path, faults_path, script_path;
    struct Tune {
        std::size_t heater = 0;
        double target_c = 0;
    };
    std::optional<Tune> tune;
    PlaceArguments place;
    BoardArguments board;
    bool simulate = false, json = false, no_heat = false, resume = false, resumable = false;
    bool dry_run = false;
    std::string socket;
};

constexpr Program program{
    "lyrrun", "Prints a .lyr file on the lines of a Linux board, or simulates it.",
    "Examples:\n"
    "  lyrrun part.lyr --simulate                         the print on a generic printer, without "
    "one\n"
    "  lyrrun part.lyr --simulate --printer printer.toml  on your own\n"
    "  lyrrun part.lyr --simulate --trace part.vcd        every edge of the motors' lines, for "
    "GTKWave\n"
    "  lyrrun part.lyr --simulate --faults faults.txt     see what the guards do about faults\n"
    "  lyrrun part.lyr --simulate --script script.txt     pause, go on, cancel at times of your "
    "own\n"
    "  lyrrun part.lyr --dry-run                          in real time, for lyrctl, without a "
    "board\n"
    "  lyrrun --printer printer.toml --check              what this board lacks for the printer\n"
    "  lyrrun --printer printer.toml --measure-latency    how fast it may step\n"
    "  lyrrun --printer printer.toml --home               find where the head is\n"
    "  lyrrun --printer printer.toml --jog x=10,z=5       and move it by so much\n"
    "  lyrrun --printer printer.toml --jog e=20 --tool 210  push filament\n"
    "  lyrrun --printer printer.toml --calibrate mesh     measure how high the bed is where\n"
    "  lyrrun --printer printer.toml --tune tool=210      find a heater's kp, ki and kd\n"
    "  lyrrun part.lyr --printer printer.toml             print\n"
    "  lyrrun part.lyr --printer printer.toml --no-heat   move the machine, touch no heater\n"
    "  lyrrun part.lyr --printer printer.toml --resumable what a loss of power left\n"
    "  lyrrun part.lyr --printer printer.toml --resume    go on at the layer that was cut off\n"
    "\n"
    "A print takes the whole path from the file and starts with the head at start_mm of the\n"
    "printer, which a printer with endstops finds by itself. Ctrl-C brings the head to rest on\n"
    "its path and releases all lines; a second Ctrl-C does so at once. Whatever ends it, all\n"
    "heaters go off. lyrctl shows and controls a print. docs/bring-up.md leads to the first one,\n"
    "docs/configuration.md explains printer.toml, docs/algorithms/heat.md the guards and the file\n"
    "of faults, docs/print-life.md pauses, scripts and resuming, docs/control-protocol.md the\n"
    "socket. What is reported goes to standard error where the trace goes to standard output.\n"
    "Exit status: 0 done, 2 options, 3 input, 4 not supported yet, 6 output, 7 the machine cannot\n"
    "or did not do it, 8 stopped on request.\n"};

// "tool=210"
std::optional<Arguments::Tune> tune_of(const std::string& value) {
    const std::size_t equals = value.find('=');
    const auto& names = config::heater_names;
    const auto name = std::find(names.begin(), names.end(), value.substr(0, equals));
    if (equals == std::string::npos || name == names.end()) return std::nullopt;
    const std::optional<double> target_c = finite_number(value.substr(equals + 1));
    if (!target_c || !(*target_c > 0)) return std::nullopt;
    return Arguments::Tune{static_cast<std::size_t>(name - names.begin()), *target_c};
}

void add_options(Options& app, Arguments& arguments) {
    add_file(app, "print", arguments.lyr_path,
             "The .lyr file that stepc wrote; it is read more than once, so that it cannot be -, "
             "standard input");
    add_file(app, "--printer", arguments.printer_path,
             "The machine: axes, limits and lines (printer.toml); needed to print; -: standard "
             "input");
    add_flag(app, "--simulate", arguments.simulate,
             "Run without a machine and without waiting; check every pulse against the file");
    add_file(app, "--trace", arguments.trace_path,
             "Write the simulated lines of the motors as a wave file (VCD); -: standard output");
    add_flag(app, "--json", arguments.json, "Report the simulation or --check as one JSON object");
    add_flag(app, "--no-heat", arguments.no_heat,
             "Pass over the temperatures and fans that the file sets");
    add_flag(app, "--dry-run", arguments.dry_run,
             "Print without a board, in real time: lines lead nowhere, heaters are models");
    add_file(app, "--socket", arguments.socket,
             "Where lyrctl reaches the print  [/run/lyr/NAME.sock]");
    add_file(app, "--faults", arguments.faults_path,
             "Break heaters and sensors of the simulation: one TIME_S FAULT HEATER a line; -: "
             "standard input");
    add_file(app, "--script", arguments.script_path,
             "Ask things of the simulated print: one TIME_S COMMAND a line; -: standard input");
    add_flag(app, "--resume", arguments.resume,
             "Go on at the layer in which the print was cut off; without endstops the head must be "
             "at start_mm in x and y");
    add_flag(app, "--resumable", arguments.resumable,
             "Tell what --resume would go on with, and do nothing");
    add_text(
        app, "--tune", "HEATER=C",
        [&arguments](const std::string& value) -> std::optional<std::string> {
            arguments.tune = tune_of(value);
            if (!arguments.tune) return "tool, bed or chamber, = and a temperature above 0";
            return std::nullopt;
        },
        "Find kp, ki and kd of a heater at a temperature, in place of a print");
    add_place_options(app, arguments.place);
    add_board_options(app, arguments.board);
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

// None without --faults.
Result<std::vector<thermal::Fault>> read_faults(const Arguments& arguments,
                                                const config::Printer& printer) {
    constexpr std::size_t most_bytes = std::size_t{1} << 20;
    const std::string& path = arguments.faults_path;
    if (path.empty()) return std::vector<thermal::Fault>();
    const Result<std::string> text = read_text(path, most_bytes);
    if (!text) return text.error();
    return thermal::parse_faults(*text, path == "-" ? standard_input_name : path, printer);
}

// None without --script.
Result<std::vector<run::TimedCommand>> read_script(const Arguments& arguments) {
    constexpr std::size_t most_bytes = std::size_t{1} << 20;
    const std::string& path = arguments.script_path;
    if (path.empty()) return std::vector<run::TimedCommand>();
    const Result<std::string> text = read_text(path, most_bytes);
    if (!text) return text.error();
    return run::parse_script(*text, path == "-" ? standard_input_name : path);
}

// Tells what may be wrong with it.
Result<run::Resumption> found_resumption(const Arguments& arguments,
                                         const config::Printer& printer) {
    Result<run::Resumption> found = run::find_resumption(printer, arguments.lyr_path);
    if (found) show(program, run::lost_entry(printer, arguments.lyr_path));
    return found;
}

// None without --resume.
Result<std::optional<run::Resumption>> resumption_of(const Arguments& arguments,
                                                     const config::Printer& printer) {
    if (!arguments.resume) return std::optional<run::Resumption>();
    Result<run::Resumption> found = found_resumption(arguments, printer);
    if (!found) return found.error();
    return std::optional(std::move(*found));
}

Status tell_resumable(const Arguments& arguments, const config::Printer& printer) {
    if (Status cut_off = run::check_cut_off(printer, arguments.lyr_path); !cut_off) return cut_off;
    const Result<run::Resumption> found = found_resumption(arguments, printer);
    if (!found) return found.error();
    return tell(run::text_of(*found, arguments.lyr_path));
}

Status tune(const Arguments& arguments, const config::Printer& printer) {
    Result<std::vector<thermal::Fault>> faults = read_faults(arguments, printer);
    if (!faults) return faults.error();
    ProgressLine line;
    run::TuneJob job{printer, arguments.tune->heater, arguments.tune->target_c, arguments.simulate,
                     std::move(*faults)};
    job.progress = [&line](const run::TuneProgress& now) {
        char text[100];
        std::snprintf(text, sizeof text, "%.1f °C, swing %d of %d, ", now.temperature_c,
                      now.swings + 1, now.of);
        line.show(text + clock_text(now.time_s));
    };
    const Result<thermal::TuneResult> result = run::tune(job);
    line.clear();
    if (!result) return result.error();
    const std::string name(config::heater_names[arguments.tune->heater]);
    char head[100];
    std::snprintf(head, sizeof head, " tuned at %g °C%s\n", arguments.tune->target_c,
                  arguments.simulate ? ", simulated" : "");
    return tell("heater " + name + " of \"" + printer.name + '"' + head +
                thermal::text_of(*result, name));
}

Status place(const Arguments& arguments, const config::Printer& printer) {
    Result<std::vector<thermal::Fault>> faults = read_faults(arguments, printer);
    if (!faults) return faults.error();
    return work_place(program, arguments.place, {printer, arguments.simulate, std::move(*faults)});
}

Status simulate(const Arguments& arguments, const config::Printer& printer) {
    const SignalWatch watch(program.name);
    Result<std::vector<thermal::Fault>> faults = read_faults(arguments, printer);
    if (!faults) return faults.error();
    std::string homing;
    if (const auto axes = home::homed_before_print(printer, arguments.resume); axes.any()) {
        const auto homed = home::home({printer, true, *faults}, axes, {});
        if (!homed) return homed.error();
        homing = home::text_of(*homed);
        homing.resize(homing.find('\n') + 1);  // where the head was then is of no use any more
    }
    Result<std::vector<run::TimedCommand>> script = read_script(arguments);
    if (!script) return script.error();
    Result<std::optional<run::Resumption>> resumption = resumption_of(arguments, printer);
    if (!resumption) return resumption.error();
    ProgressLine line;
    run::SimulationJob job{arguments.lyr_path, printer, {}, shown_on(line), {}};
    job.no_heat = arguments.no_heat;
    job.faults = std::move(*faults);
    job.script = std::move(*script);
    job.resumption = std::move(*resumption);
    if (!arguments.trace_path.empty()) job.trace = arguments.trace_path;
    job.ended = [&line](const Diagnostics& notes) {
        line.clear();
        show(program, notes);
    };
    const Result<run::SimulationReport> report = run::simulate(job);
    line.clear();
    if (!report) return report.error();
    show(program, report->notes);
    const std::string text =
        arguments.json ? run::json_of(*report) : run::text_of(*report) + homing;
    if (const Status told = tell(text, {{"the trace", arguments.trace_path}}); !told) return told;
    if (report->within_limits()) return Done{};
    return Diagnostic{Severity::error,
                      ExitStatus::machine,
                      "the pulses leave the file's path by more than half a microstep, or are "
                      "shorter than the drivers need",
                      {.file = arguments.lyr_path}};
}

// A print that begins anew forgets what was cut off.
void tell_forgotten(const Arguments& arguments, const config::Printer& printer) {
    if (arguments.resume || arguments.dry_run) return;
    if (!run::check_cut_off(printer, arguments.lyr_path)) return;
    const Result<run::Resumption> found = run::find_resumption(printer, arguments.lyr_path);
    if (!found) return;
    std::string text = run::text_of(*found, arguments.lyr_path);
    text.pop_back();
    show(program,
         {{Severity::note, ExitStatus::ok, text + "; it begins anew, without --resume", {}}});
}

Status print(const Arguments& arguments, const config::Printer& printer) {
    if (arguments.resume && !arguments.dry_run)
        if (Status cut_off = run::check_cut_off(printer, arguments.lyr_path); !cut_off)
            return cut_off;
    tell_forgotten(arguments, printer);
    Result<std::optional<run::Resumption>> resumption = resumption_of(arguments, printer);
    if (!resumption) return resumption.error();
    ProgressLine line;
    run::PrintControl control;
    run::PrintStatus before;
    before.file = arguments.lyr_path;
    control.publish(before);
    Result<PrintServer> server = PrintServer::open(arguments.socket, printer, control);
    if (!server) return server.error();
    run::PrintJob job{arguments.lyr_path, printer, arguments.no_heat, shown_on(line)};
    job.resumption = std::move(*resumption);
    job.is_lifted = home::homed_before_print(printer, arguments.resume).any();
    if (job.is_lifted)
        job.before = [&job](gpio::GpioChip& chip, gpio::Clock& clock, const run::StopSource& stop,
                            const run::NoteRisen& note) {
            return home::home_before_print(job.printer, job.resumption, chip, clock, stop, note);
        };
    if (!arguments.dry_run) job.journal = run::journal_path(printer, arguments.lyr_path);
    job.forgets_others = !arguments.dry_run && counts_on_height(printer);
    job.control = &control;
    job.is_reachable = server->is_reachable();
    job.checked = [&](const Diagnostics& notes) {
        show(program, server->notes());
        show(program, notes);
    };
    job.begun = [&] { server->start(); };
    const Result<run::PrintReport> report = arguments.dry_run ? run::dry_run(job) : run::print(job);
    line.clear();
    if (!report) return report.error();
    show(program, Diagnostics(report->warnings.begin() + static_cast<std::ptrdiff_t>(report->told),
                              report->warnings.end()));
    return tell(arguments.lyr_path + (arguments.dry_run ? " tried on \"" : " printed on \"") +
                printer.name + "\"\n" + run::text_of(*report));
}

// A print, or what is said about one.
bool asks_of_a_print(const Arguments& arguments) {
    return !arguments.lyr_path.empty() || !arguments.trace_path.empty() ||
           !arguments.script_path.empty() || !arguments.socket.empty() || arguments.dry_run ||
           arguments.no_heat || arguments.resume || arguments.resumable;
}

Status check_board_together(const Arguments& arguments) {
    const BoardArguments& board = arguments.board;
    if (arguments.printer_path.empty()) {
        const char* option = board.off ? "--off" : board.check ? "--check" : "--measure-latency";
        if (board.off || board.check || board.measure)
            return usage(std::string(option) +
                         " needs --printer FILE, which says what the machine is");
    }
    if (board.off) {
        if (board.check || board.measure || board.lines || board.has_seconds ||
            asks_of_a_print(arguments) || arguments.tune || arguments.place.given() ||
            arguments.simulate || arguments.json || !arguments.faults_path.empty())
            return usage("--off goes with --printer alone");
        return Done{};
    }
    if (board.check == board.measure)
        return usage(board.check ? "--check goes without --measure-latency"
                                 : "--lines goes with --measure-latency");
    if (board.lines && board.check) return usage("--lines goes with --measure-latency");
    if (board.check && board.has_seconds) return usage("--seconds goes with --measure-latency");
    if (asks_of_a_print(arguments) || arguments.tune || arguments.place.given() ||
        arguments.simulate || !arguments.faults_path.empty() || (arguments.json && !board.check))
        return usage(board.check ? "--check goes with --printer and --json alone"
                                 : "--measure-latency goes with --printer, --seconds and --lines "
                                   "alone");
    return Done{};
}

// What makes no sense together.
Status check_together(const Arguments& arguments) {
    if (arguments.board.given()) return check_board_together(arguments);
    if (arguments.board.has_seconds) return usage("--seconds goes with --measure-latency");
    if (arguments.place.tool_c && !arguments.place.feed_mm)
        return usage("--tool goes with --jog e=MM");
    if (arguments.place.feed_mm &&
        (arguments.place.home || arguments.place.jog_mm || arguments.place.calibrate))
        return usage("--jog e=MM goes alone, with --tool");
    if (arguments.tune && arguments.place.given())
        return usage("--tune goes without --home, --jog and --calibrate");
    if (arguments.place.calibrate && (arguments.place.home || arguments.place.jog_mm))
        return usage("--calibrate homes by itself: it goes without --home and --jog");
    if (arguments.place.given() || arguments.tune) {
        if (asks_of_a_print(arguments) || arguments.json)
            return usage(
                "--tune, --home, --jog and --calibrate go without a print and what is said of one: "
                "with --printer, --simulate and --faults alone");
    } else if (arguments.lyr_path.empty()) {
        return usage(
            "print is required, the .lyr file that stepc wrote, or --check, --measure-latency, "
            "--tune, --home, --jog, --calibrate or --off");
    }
    if (!arguments.simulate && !arguments.faults_path.empty())
        return usage("--faults needs --simulate");
    if ((arguments.dry_run || !arguments.socket.empty()) && arguments.simulate)
        return usage("--dry-run and --socket go with a print, not with --simulate");
    if (!arguments.simulate && !arguments.script_path.empty())
        return usage("--script needs --simulate");
    if (arguments.resume && arguments.resumable)
        return usage("--resumable tells what --resume would do: give one of them");
    if (arguments.no_heat && !arguments.faults_path.empty())
        return usage("--faults has nothing to break with --no-heat");
    const int inputs = (arguments.printer_path == "-") + (arguments.faults_path == "-") +
                       (arguments.script_path == "-");
    if (inputs > 1)
        return usage("only one of --printer, --faults and --script can be standard input");
    return Done{};
}

Status work(const Arguments& arguments) {
    if (const Status together = check_together(arguments); !together) return together;
    // The whole file is checked before the first motion, and then read again.
    if (arguments.lyr_path == "-")
        return usage("a print is read more than once: give a file, not standard input");
    if (!arguments.simulate && !arguments.dry_run && !arguments.resumable &&
        arguments.printer_path.empty())
        return usage(
            "without --simulate and --dry-run, --printer FILE must say what the machine is");
    if (!arguments.simulate &&
        (!arguments.trace_path.empty() || (arguments.json && !arguments.board.check)))
        return usage("--trace and --json need --simulate");
    if (const Status apart = check_apart({{"the print", arguments.lyr_path},
                                          {"the printer's file", arguments.printer_path},
                                          {"the faults", arguments.faults_path},
                                          {"the script", arguments.script_path}},
                                         {{"the trace", arguments.trace_path}});
        !apart)
        return apart;
    const Result<config::Printer> printer = read_printer(arguments.printer_path);
    if (!printer) return printer.error();
    if (arguments.board.given())
        return work_board(program, arguments.board, *printer, arguments.json);
    if (arguments.tune) return tune(arguments, *printer);
    if (arguments.place.given()) return place(arguments, *printer);
    if (arguments.resumable) return tell_resumable(arguments, *printer);
    return arguments.simulate ? simulate(arguments, *printer) : print(arguments, *printer);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](Options& app) { add_options(app, arguments); },
        [&](const Options& app) {
            arguments.board.has_seconds = app.count("--seconds") != 0;
            return work(arguments);
        });
}
