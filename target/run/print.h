// A real print: planning in one thread, edges in another, and this one waiting for signals and telling
// how far the print is.
//
// Contract
//  1. Nothing moves before inspect() has found the whole file right and check_demands() has found
//     nothing that this machine cannot do. A file that is changed after that ends the print, and nothing of what is new
//     in it is printed.
//  2. Heaters do what the file orders, tended by a thread of their own; with `no_heat` none is touched. When a guard
//     fires, all heaters are off at once, the head comes to rest, and the guard's message (status machine) is the
//     result.
//  3. However the print ends (done, error, request), all lines are inactive and released before
//     print() returns.
//  4. The first SIGINT, SIGTERM or SIGHUP takes the heat away and brings the head to rest on its path, a second one stops
//     at once; both end with status stopped. Where a sensor or the file hangs at the end, they end the program, which
//     holds no line of a motor any more.
//     A processor that timing.cpu names and this board lacks is an error before anything is held.
//  5. The pulses are those of the simulation, in the same order, with at least the same gaps.
//  6. Commands of `control` are served as life.h says, by this thread; it tells there what the print is, to its end.
//     While `before` is done they are what opening.h says; heaters are tended and inputs watched from then on.
//  7. With a journal (journal.h) the print can be resumed after it was cut off, also by a signal or a guard, and also
//     where a resumption ends before its path; one that is done or cancelled takes it away. A journal that cannot be
//     written, or is another printer's, is a warning, before anything moves and in the status. What is there of an
//     earlier print on this printer is gone before anything moves, or, if this one resumes it, can be written; or else
//     nothing moves (status output).
//  8. The watchdog is fed by this thread as long as the heaters' thread ticks and the real-time one goes on; a write that
//     hangs for silent_s takes the heat away as a guard does. The init system is told how it goes.
//  9. Buttons and sensors act as life.h says; input lines that cannot be read take heat and motion away, as a guard does.
// 10. Where the head is afterwards is known unless the message says that its position is lost.

#pragma once

#include <array>

#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"
#include "target/run/buttons.h"
#include "target/run/heating.h"
#include "target/run/resumption.h"
#include "target/run/simulate.h"
#include "target/run/stop_signals.h"

namespace lyr::run {

// What became of what comes before the path.
struct Before {
    Before(Status what = Done{}, double mm = 0) : status(std::move(what)), risen_mm(mm) {}
    Status status;
    double risen_mm;  // how far the head has gone up, done or not
};

// Of a head that has gone up by so much, or is about to come down to that: it is on the disk when this returns, or an
// error.
using NoteRisen = std::function<Status(double risen_mm)>;

struct PrintJob {
    std::string file;
    config::Printer printer;
    bool no_heat = false;
    ProgressSink progress;
    // What is done on the lines before the print, such as homing: the motors are to stay on and the head at start_mm.
    std::function<Before(gpio::GpioChip&, gpio::Clock&, const StopSource&, const NoteRisen&)>
        before{};
    PrintControl* control = nullptr;  // none: only signals and buttons do something
    bool is_reachable = true;         // somebody can give the control commands
    // Called once, when the file and the printer are found right: no line is held yet, and signals still end the program.
    // What is said later may wait for a terminal with the motors on: so it gets all that is to be said of what is to come.
    std::function<void(const Diagnostics& notes)> checked{};
    // Called once, when all lines are held, and before `before`; from here on threads may be started.
    std::function<void()> begun{};
    std::string journal{};  // its path; empty: none
    bool forgets_others = false;  // what was cut off beside it takes its height from the head
    std::optional<Resumption> resumption{};
    bool is_lifted = false;  // for the resumption, and at start_mm in x and y: homed
};

struct PrintReport {
    double planned_s = 0;
    double stretched_s = 0;  // how much longer it took
    std::int64_t worst_late_ns = 0;
    std::optional<unsigned> cpu;  // that wrote all lines
    std::uint64_t writes = 0;
    double waited_s = 0;  // for temperatures
    double paused_s = 0;
    double slowed_s = 0;  // by commands for a lower speed
    // How late waits ended; the buckets are those of TracingClock.
    std::array<std::uint64_t, gpio::TracingClock::buckets> lateness{};
    Diagnostics warnings;
    std::size_t told = 0;  // so many of the warnings, the first, were known before anything moved
};

// On the lines that the printer's file names.
Result<PrintReport> print(const PrintJob& job);
// On any lines and clock, and any heaters and buttons; none: nothing is heated, nothing pressed.
Result<PrintReport> print(const PrintJob& job, gpio::GpioChip& chip, gpio::Clock& clock,
                          Heating* heating = nullptr, Buttons* buttons = nullptr);

std::string text_of(const PrintReport& report);

}  // namespace lyr::run
