// The printer's output lines, as one set that is written together. This is the only way in which
// the printer side touches the outside: whoever holds a GpioChip can be run against a board, a
// recording or a wave file without knowing which.
//
// An abstract class and not a std::variant: implementations wrap each other (a trace around any
// chip), the real one must not pull gpiod.h into every room, and tests add faulty chips of their
// own. The virtual call costs about a nanosecond where the system call behind it costs a thousand.
//
// Contract, the same for every implementation
//  1. Lines are numbered from 0 in the order in which they were requested, at most 64. From the
//  request
//     until the first write every line is inactive.
//  2. write(changed, levels) gives the lines in `changed` the state of their bit in `levels` (1 is
//     active); all other lines keep theirs. Bits beyond the lines requested are ignored.
//  3. Lines of one kernel chip that change in one write change in one system call; with libgpiod 1.6 those of
//     one drive do.
//  4. An active-low line is active at the low level. Only the implementation knows.
//  5. A failed write returns the diagnostic; the state of the lines is then what the kernel made of
//  it,
//     and the next write sets every line of that chip anew.
//  6. release() makes every line inactive and hands the lines back; so does the destructor.
//  Afterwards
//     write() fails.
//  7. Nothing but a failure allocates memory in write().

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "base/diagnostic.h"

namespace lyr::gpio {

// Bit i stands for the i-th line requested.
using LineMask = std::uint64_t;
inline constexpr std::size_t max_lines = 64;

constexpr LineMask line_bit(std::size_t line) {
    return LineMask{1} << line;
}
constexpr LineMask all_lines(std::size_t count) {
    return count >= max_lines ? ~LineMask{0} : line_bit(count) - 1;
}

// How a line goes to its high level: driven there, or let go, so that a resistor may pull it up.
enum class Drive : std::uint8_t { push_pull, open_drain };

// What to request: a line of a kernel chip, by its number there or by its name.
struct LineRequest {
    std::string purpose;  // "axis.x.step": in messages
    std::string chip;     // "gpiochip0", "/dev/gpiochip0" or a label such as "pinctrl-bcm2835"
    std::variant<std::uint32_t, std::string> line;
    bool active_low = false;
    Drive drive = Drive::push_pull;  // of outputs
};

class GpioChip {
public:
    virtual ~GpioChip() = default;
    virtual std::size_t line_count() const = 0;
    virtual Status write(LineMask changed, LineMask levels) = 0;
    virtual Status release() = 0;
};

}  // namespace lyr::gpio
