// Real input lines, through libgpiod.
//
// Contract (beside that of InputLines)
//  1. Refusals are as those of open_gpiod_chip(): purpose, chip, line and what to do. Nothing is held then.
//  2. A pull that the kernel or the chip cannot set is a diagnostic that names the line, not a line that floats.
//  3. The same line may not be requested twice, nor by an output too.

#pragma once

#include <memory>
#include <span>

#include "target/gpio/input_lines.h"

namespace lyr::gpio {

Result<std::unique_ptr<InputLines>> open_gpiod_inputs(std::span<const InputRequest> requests);

}  // namespace lyr::gpio
