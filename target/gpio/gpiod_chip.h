// Real lines, through libgpiod 1.6 and the kernel's GPIO character devices.
//
// Contract (beside that of GpioChip)
//  1. All lines of one kernel chip are held by one bulk request, so that what changes together
//  leaves in
//     one ioctl. Therefore active-low is applied here and not by the kernel: there it would be a
//     property of the whole request.
//  2. A chip or line that is missing, held by someone else, or not permitted gives a diagnostic
//  (status
//     machine) that names the purpose, the chip and the line, and says what to do. Nothing is held
//     then.
//  3. No lines, or more than 64, is a diagnostic.
//  4. Two requests for the same line are a diagnostic that names both purposes.

#pragma once

#include <memory>
#include <span>

#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

Result<std::unique_ptr<GpioChip>> open_gpiod_chip(std::span<const LineRequest> requests);

}  // namespace lyr::gpio
