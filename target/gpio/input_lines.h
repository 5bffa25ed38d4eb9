// The printer's input lines: endstops, a probe, a stop button, a filament sensor. Levels can be read at any time; edges
// are kept by the kernel with the time at which they came, so that one that is collected late is no less exact.
//
// An abstract class for the same reasons as GpioChip. Contacts bounce: edges come here as they are, and debounce.h says
// which of them count.
//
// Contract, the same for every implementation
//  1. Lines are numbered from 0 in the order in which they were requested, at most 64. Bit i of levels is 1 while line i
//     is active: at the low level for an active-low line.
//  2. Every change of a line after the request becomes one edge, with its time on the clock of MonotonicClock.
//  3. collect() gives edges in order of time, as many as there is room for, and never waits. A change that comes while
//     it runs may be left for the next call.
//  4. wait_ns() returns true as soon as there is something to collect, and false after so long without; 0 asks.
//  5. A failure (a chip that was unplugged) returns its diagnostic, status machine. Edges that the kernel had to drop
//     because nobody collected them in time are a failure too, unless the line may chatter: then the last edge given is
//     as the line is now.
//  6. Nothing but a failure allocates memory.
//  7. One thread at a time uses it. Lines are handed back by the destructor.

#pragma once

#include <cstdint>
#include <span>

#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

// What holds a line that nothing drives.
enum class Pull : std::uint8_t { as_is, up, down, none };

struct InputRequest {
    LineRequest line;
    Pull pull = Pull::as_is;
    bool may_chatter = false;
};

struct InputEdge {
    std::int64_t time_ns = 0;
    std::uint8_t line = 0;
    bool active = false;  // afterwards
};

class InputLines {
public:
    virtual ~InputLines() = default;
    virtual std::size_t line_count() const = 0;
    virtual Result<LineMask> read() = 0;
    // How many of `edges` were filled.
    virtual Result<std::size_t> collect(std::span<InputEdge> edges) = 0;
    virtual Result<bool> wait_ns(std::int64_t time_ns) = 0;
};

}  // namespace lyr::gpio
