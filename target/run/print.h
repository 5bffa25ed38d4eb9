// A real print: planning in one thread, edges in another, and this one waiting for signals and telling
// how far the print is.
//
// Contract
//  1. Nothing moves before inspect() has found the whole file right and check_demands() has found
//     nothing that this machine cannot do.
//  2. Heaters do what the file orders, tended by a thread of their own; with `no_heat` none is touched. When a guard
//     fires, all heaters are off at once, the head comes to rest, and the guard's message (status machine) is the
//     result.
//  3. However the print ends (done, error, request), all lines are inactive and released before
//     print() returns.
//  4. The first SIGINT, SIGTERM or SIGHUP brings the head to rest on its path, a second one stops at
//     once; both end with status stopped.
//  5. The pulses are those of the simulation, in the same order, with at least the same gaps.

#pragma once

#include <array>

#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"
#include "target/run/heating.h"
#include "target/run/simulate.h"

namespace lyr::run {

struct PrintJob {
    std::string file;
    config::Printer printer;
    bool no_heat = false;
    ProgressSink progress;
    // What is done on the lines before the print, such as homing: the motors are to stay on and the head at start_mm.
    std::function<Status(gpio::GpioChip&, gpio::Clock&)> before{};
};

struct PrintReport {
    double planned_s = 0;
    double stretched_s = 0;  // how much longer it took
    std::int64_t worst_late_ns = 0;
    std::uint64_t writes = 0;
    double waited_s = 0;  // for temperatures
    // How late waits ended; the buckets are those of TracingClock.
    std::array<std::uint64_t, gpio::TracingClock::buckets> lateness{};
    Diagnostics warnings;
};

// On the lines that the printer's file names.
Result<PrintReport> print(const PrintJob& job);
// On any lines and clock, and any heaters; none: nothing is heated.
Result<PrintReport> print(const PrintJob& job, gpio::GpioChip& chip, gpio::Clock& clock,
                          Heating* heating = nullptr);

std::string text_of(const PrintReport& report);

}  // namespace lyr::run
