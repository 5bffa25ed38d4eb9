// How late this board wakes the thread that writes the lines, and how long a write takes: measured by waiting and
// writing as a print does, for the planner to ask no more of it.
//
// Method. Half of the time the thread sleeps from wait to wait as between the steps of a slow motion, half of it the
// waits are so dense that it never sleeps, as at full speed; a kernel that takes the processor away from a real-time
// thread that does not sleep shows there. Every core has ordinary work to do meanwhile.
//
// Contract
//  1. Every wait is counted; the lateness that is `rare` is exceeded by one wait in 10,000 and `worst` by none.
//  2. Lines are written only if there is a chip: every one of its lines its inactive level, which it has.
//  3. printer.toml's keys timing.late_us and timing.write_us are the rare ones, of both kinds of wait the later.
//  4. A wait that ended later than the printer allows a print's edge to come is a warning.
//  5. text_of() is TOML: two keys, and comments.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"

namespace lyr::board {

// Of so many waits or writes.
struct Spread {
    std::size_t count = 0;
    std::int64_t median_ns = 0, rare_ns = 0, worst_ns = 0;
};
// Sorts what it is given.
Spread spread_of(std::vector<std::int64_t>& times_ns);

struct LatencyReport {
    std::string printer;
    Spread asleep, awake;                  // how late waits ended, after sleeping and without
    std::optional<Spread> write;           // none: no lines were written
    std::vector<std::uint64_t> histogram;  // bucket k: less than 2^k us late, of all waits
    double steps_per_s = 0;                // what a motor may be asked for then
    Diagnostics warnings;
};

struct LatencyJob {
    config::Printer printer;
    double seconds = 10;
    bool lines = false;  // write those of the motors
};

// On this board, in a thread like a print's.
Result<LatencyReport> measure_latency(const LatencyJob& job);
// On any clock; `chip` may be none.
Result<LatencyReport> measure_latency(const LatencyJob& job, gpio::Clock& clock,
                                      gpio::GpioChip* chip);

std::string text_of(const LatencyReport& report);

}  // namespace lyr::board
