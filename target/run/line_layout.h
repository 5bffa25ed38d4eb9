// Which bit of the line mask is which line of which axis. The same for a board, a simulation and a
// trace.
//
// Contract
//  1. Axis a has its step line at bit 2a and its direction line at bit 2a + 1; the enable lines that
//     the printer has follow in the order of the axes.
//  2. `names` has one name a line, such as "x.step"; requests are named by their keys, "axis.x.step".
//  3. line_requests() fails (status machine) with the key that is missing if an axis has no step or no
//     direction line.

#pragma once

#include <string>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/gpio_chip.h"
#include "target/gpio/input_lines.h"

namespace lyr::run {

constexpr gpio::LineMask step_bit(std::size_t axis) {
    return gpio::line_bit(2 * axis);
}
constexpr gpio::LineMask direction_bit(std::size_t axis) {
    return gpio::line_bit(2 * axis + 1);
}

inline constexpr gpio::LineMask all_step_bits = [] {
    gpio::LineMask bits = 0;
    for (std::size_t i = 0; i < config::axis_count; ++i) bits |= step_bit(i);
    return bits;
}();
inline constexpr gpio::LineMask all_direction_bits = all_step_bits << 1;

// Beyond all lines: events at which one of these changes are marks of heat_order.h, and gates of them.
inline constexpr gpio::LineMask mark_bit = gpio::line_bit(gpio::max_lines - 1);
inline constexpr gpio::LineMask gate_bit = gpio::line_bit(gpio::max_lines - 2);
inline constexpr gpio::LineMask all_mark_bits = mark_bit | gate_bit;

struct LineLayout {
    std::vector<std::string> names;
    gpio::LineMask enable = 0;
};

LineLayout line_layout(const config::Printer& printer);

// Lines of printer.toml as target/gpio asks for them.
gpio::LineRequest line_request(std::string purpose, const config::Pin& pin, bool inverted = false);
gpio::InputRequest input_request(std::string purpose, const config::Pin& pin);

Result<std::vector<gpio::LineRequest>> line_requests(const config::Printer& printer);

}  // namespace lyr::run
