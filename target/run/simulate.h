// The print without a printer: the whole program with a virtual clock and lines that lead to a decoder.
// What it reports is read off the lines, not taken from the plan.
//
// Contract
//  1. Everything but clock and lines is what a real print runs: the same reader, interpreter, planner,
//     pulses and executor, in the same order.
//  2. The report's deviation is that between the positions decoded from the lines and
//       a. the curves of the file, read and decoded a second time (path_check.h; step_checks.h for machines
//          that are not plain Cartesian ones),
//       b. the planned and shaped motion at the same time, at every step, between steps and at the end.
//  3. within_limits() says that no axis ever deviated, in either sense, by more than half a step, what the
//     axis moves at its highest speed in the nanosecond that times are rounded to, and a millionth of a
//     step for rounding together; and that no pulse was shorter than the printer's file asks.
//  4. Heaters are models behind mock lines (thermal/simulated_heat.h), unless `no_heat`, or the file asks for none.
//     What a print is refused for is refused, but pauses that nobody would end. `faults` break heaters at their
//     times; a guard that fires ends the simulation with its message (status machine) and the time.
//  5. `script` gives commands at their times, one that is refused or comes after the end is a warning, and the pauses
//     that the file asks for are made. A script that has ended while the print rests ends it. What the head does on
//     trips is no part of 2.
//  6. With a trace path, the lines are written there as a wave file, which appears whole or not at all.

#pragma once

#include <functional>
#include <optional>
#include <string>

#include "target/config/printer.h"
#include "target/run/file_path.h"
#include "target/run/path_check.h"
#include "target/run/print_control.h"
#include "target/run/pulse_decoder.h"
#include "target/run/resumption.h"
#include "target/thermal/faults.h"

namespace lyr::run {

struct Progress {
    std::uint32_t layer = 0;  // from 1, 0: before the first
    std::uint32_t layers = 0;
    double time_s = 0;       // of the print
    double estimated_s = 0;  // of the whole print, as the file states it; 0: it does not
};
using ProgressSink = std::function<void(const Progress&)>;
// Asked now and then; true ends the simulation with status stopped.
using StopQuestion = std::function<bool()>;

// What else may happen to a board.
struct LineFaults {
    gpio::MockChip::Fault motors{}, heaters{};  // by the number of the write
    std::vector<double> signals_s{};            // times of SIGTERM, in order
};

struct SimulationJob {
    std::string file;
    config::Printer printer;
    std::optional<std::string> trace;
    ProgressSink progress;
    StopQuestion stop;
    bool no_heat = false;
    std::vector<thermal::Fault> faults{};
    std::vector<TimedCommand> script{};  // in order of time
    PrintControl* control = nullptr;     // to look on from outside
    std::optional<Resumption> resumption{};
    LineFaults line_faults{};
    // Of one that ends early, and so has no report: hears its notes.
    std::function<void(const Diagnostics&)> ended{};
    // After each tick of the heaters, and at the end.
    std::function<void(double time_s, bool any_heater_on)> heat_watch{};
};

// What a heater did.
struct HeatFigures {
    std::size_t heater = 0;   // of config
    double highest_c = 0;     // that was measured
    double full_power_s = 0;  // time at full power that its power adds up to
};

struct SimulationReport {
    std::string file;
    config::Printer printer;
    PathTotals totals;
    double filament_diameter_mm = 0;
    double print_time_s = 0;
    std::int64_t delayed_ns = 0;  // of it, because drivers need time between edges
    std::array<PulseFigures, config::axis_count> pulses;
    StepPositions positions{};  // at the end, from the start of the print
    std::uint64_t writes = 0;
    Deviation path;                 // 2a
    AxisValues planned_steps{};     // 2b
    double waited_s = 0;            // for temperatures, beside the print time
    double paused_s = 0;            // by command or by the file
    double slowed_s = 0;            // by commands for a lower speed
    StepPositions trip_steps{};     // that trips left behind, with the one from the end of the path
    std::vector<HeatFigures> heat;  // of the heaters that had a target
    Diagnostics
        notes;  // what the file asks and a simulation passes over, what of the script was refused

    double worst_steps() const;
    bool within_limits() const;
};

Result<SimulationReport> simulate(const SimulationJob& job);

// For people, several lines; for programs, one JSON object.
std::string text_of(const SimulationReport& report);
std::string json_of(const SimulationReport& report);

}  // namespace lyr::run
