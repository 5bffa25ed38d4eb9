// How late this board wakes the thread that writes the lines, and how long a write takes: measured by waiting and
// writing as a print does, for the planner to ask no more of it.
//
// Method. Half of the time the thread sleeps from wait to wait as between the steps of a slow motion, half of it the
// waits are so dense that it never sleeps, as at full speed; a kernel that takes the processor away from a real-time
// thread that does not sleep shows there. Every core has ordinary work to do meanwhile.
//
// Contract
//  1. Every wait is counted; the lateness that is `rare` is exceeded by at most one wait in 10,000 and `worst` by none.
//     `worst` is exact; the others are, below 8 us, and above too high by less than one part in 4096.
//  2. Lines are written only if there is a chip: every one of its lines its inactive level, which it has.
//  3. printer.toml's keys timing.late_us and timing.write_us are the rare ones, of both kinds of wait the later.
//  4. A wait that ended later than the printer allows a print's edge to come is a warning.
//  5. text_of() is TOML: two keys, and comments. Where the printer's file has a [timing] already, which TOML allows only
//     once, the keys are comments too, and a note says so.
//  6. What is held does not grow with the time that is measured.

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

// How often waits or writes took how long.
class Times {
public:
    void add(std::int64_t time_ns);
    Spread spread() const;
    // Bucket k: those of less than 2^k us that are in no bucket before.
    void add_to(std::vector<std::uint64_t>& histogram) const;

private:
    // The highest 13 bits of a time tell its bucket, so that those below 2^13 ns have one each. None takes longer than
    // 2^40 ns, 18 minutes.
    static constexpr int exact_bits = 13, most_bits = 40;
    static constexpr std::size_t half = std::size_t{1} << (exact_bits - 1);

    static std::size_t bucket_of(std::uint64_t time_ns);
    // The longest time in it.
    static std::int64_t end_ns(std::size_t bucket);
    // So many are no shorter than it.
    std::int64_t place_from_above(std::uint64_t number) const;

    std::vector<std::uint32_t> counts_ =
        std::vector<std::uint32_t>((most_bits - exact_bits + 2) * half);
    std::size_t count_ = 0;
    std::int64_t worst_ns_ = 0;
};

struct LatencyReport {
    std::string printer;
    Spread asleep, awake;                  // how late waits ended, after sleeping and without
    std::optional<Spread> write;           // none: no lines were written
    std::vector<std::uint64_t> histogram;  // bucket k: less than 2^k us late, of all waits
    double steps_per_s = 0;                // what a motor may be asked for then
    bool has_timing = false;               // the printer's file has a [timing] already
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
