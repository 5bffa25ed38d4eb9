#include "apps/lyrrun_board.h"

#include "apps/files.h"
#include "apps/signal_watch.h"
#include "target/board/check.h"
#include "target/board/latency.h"
#include "target/gpio/gpiod_chip.h"
#include "target/run/heating.h"

namespace lyr::command_line {
namespace {

Status check_board(const config::Printer& printer, bool json) {
    const std::vector<board::Finding> findings = board::check(printer, board::this_board());
    const Status told =
        tell(json ? board::json_of(printer.name, findings) : board::text_of(findings));
    if (!told || board::worst(findings) != Severity::error) return told;
    return machine_error("this board cannot print what \"" + printer.name + "\" asks for");
}

Status measure(const Program& program, const BoardArguments& arguments,
               const config::Printer& printer) {
    const SignalWatch watch(program.name);
    const auto report = board::measure_latency({printer, arguments.seconds, arguments.lines});
    if (!report) return report.error();
    show(program, report->warnings);
    return tell(board::text_of(*report));
}

}  // namespace

void add_board_options(Options& app, BoardArguments& arguments) {
    add_flag(app, "--check", arguments.check,
             "Look whether this board has the lines, sensors and rights that the printer's file "
             "asks for, in place of a print; nothing moves");
    add_flag(app, "--measure-latency", arguments.measure,
             "Measure how late this board wakes the thread that steps, in place of a print");
    add_flag(
        app, "--off", arguments.off,
        "Switch heaters and motors off, as a print that was killed may have left them; one that "
        "is at work is left alone");
    add_flag(app, "--lines", arguments.lines,
             "With --measure-latency: write the motors' lines too, all of them inactive");
    add_numbers(app, "--seconds", "N", std::span(&arguments.seconds, 1), {0.1, 3'600, "s"},
                "With --measure-latency: how long to measure");
}

Status work_board(const Program& program, const BoardArguments& arguments,
                  const config::Printer& printer, bool json) {
    if (arguments.off) return run::switch_off(printer, gpio::open_gpiod_chip);
    if (arguments.check) return check_board(printer, json);
    return measure(program, arguments, printer);
}

}  // namespace lyr::command_line
