// Homing, and what comes after it, as a program does it: on the lines of the printer's file or on a simulated machine.
//
// Contract
//  1. Nothing moves before jogs were found possible as far as that can be known.
//  2. Afterwards all lines are inactive and released, so that the motors are off and the place is lost: a print homes
//     again. home_before_print() leaves the motors on, for a print on the same lines.
//  3. A jog ends within the ranges of the printer's file, or is refused (status machine) before it moves.
//  4. Before a print that resumes, the nozzle stands in the part: nothing moves sideways before it was lifted, and only x
//     and y are homed, the height being that of the resumption. A delta, which homes upwards, finds its height too. The
//     print begins where run::lifted() says. How high the head is meanwhile is noted once it is there, and before it
//     comes down: what was noted last is never more than that.
//  5. What the kernel refuses of real time is a warning.

#pragma once

#include <functional>
#include <optional>
#include <string>

#include "target/home/homing.h"
#include "target/run/print.h"
#include "target/thermal/faults.h"

namespace lyr::home {

struct Job {
    config::Printer printer;
    bool simulate = false;
    std::vector<thermal::Fault> faults{};  // of a simulation
};

struct Report {
    motion::Point head;  // at the end
    AxisSet homed;
    double repeat_mm = 0;
    double time_s = 0;
    Diagnostics warnings{};
};

// What is done on a machine that is set up; an emergency line and SIGINT stop it.
using Work = std::function<Status(Mover& mover)>;
Status with_machine(const Job& job, Diagnostics& warnings, const Work& work);

// Homes, and goes to the start of a print; a jog, where given, follows. Without axes to home, a jog begins in the middle
// of the ranges.
Result<Report> home(const Job& job, AxisSet axes, const std::optional<motion::Point>& jog_mm);

// What a print on this printer begins with homing; none: with nothing.
AxisSet homed_before_print(const config::Printer& printer, bool resumes);
run::Before home_before_print(const config::Printer& printer,
                              const std::optional<run::Resumption>& resumption,
                              gpio::GpioChip& chip, gpio::Clock& clock, const run::StopSource& stop,
                              const run::NoteRisen& note);
Status home_before_print(Mover& mover, const config::Printer& printer,
                         const std::optional<run::Resumption>& resumption,
                         const run::NoteRisen& note = {});

std::string text_of(const Report& report);

}  // namespace lyr::home
