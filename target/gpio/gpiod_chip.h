// Real lines, through libgpiod (1.6 or 2.x, as it was built) and the kernel's GPIO character devices.
//
// Contract (beside that of GpioChip)
//  1. All lines of one kernel chip are held by one request, so that what changes together leaves in one ioctl;
//     with libgpiod 1.6 one request for each drive. Active-low is applied here and not by the kernel.
//  2. A chip or line that is missing, held by someone else, or not permitted gives a diagnostic (status
//     machine) that names the purpose, the chip and the line, and says what to do. Nothing is held then.
//  3. No lines, or more than 64, is a diagnostic.
//  4. Two requests for the same line are a diagnostic that names both purposes.
//  5. look_up_line() says where a request leads, and holds nothing.

#pragma once

#include <memory>
#include <optional>
#include <span>

#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

Result<std::unique_ptr<GpioChip>> open_gpiod_chip(std::span<const LineRequest> requests);

struct FoundLine {
    std::string chip;  // "gpiochip0"
    std::uint32_t number = 0;
    std::string name;                 // empty: it has none
    std::optional<std::string> user;  // who holds it
};
Result<FoundLine> look_up_line(const LineRequest& request);

}  // namespace lyr::gpio
