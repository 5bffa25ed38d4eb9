// Finding chips and lines with libgpiod 1.6, and saying why they cannot be had. Private to this room.

#pragma once

#include <gpiod.h>

#include <memory>

#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

inline constexpr const char* line_consumer = "lyrrun";

struct CloseChip {
    // Closing a chip releases all lines held through it.
    void operator()(gpiod_chip* chip) const { ::gpiod_chip_close(chip); }
};
using ChipHandle = std::unique_ptr<gpiod_chip, CloseChip>;

Diagnostic machine_error(std::string message);
// "x.step: line 17 of gpiochip0"
std::string line_text(const LineRequest& request);
Result<ChipHandle> open_chip(const LineRequest& request);
// A line of the chip that nobody holds.
Result<gpiod_line*> find_line(gpiod_chip* chip, const LineRequest& request);

}  // namespace lyr::gpio
