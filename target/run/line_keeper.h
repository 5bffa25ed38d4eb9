// Heater lines in a process of their own, which outlives a crash of the program: a line that the kernel gets back
// keeps its level on many boards, and a heater would stay on for good.
//
// Contract
//  1. keep_lines() starts a process, opens the chip there with `open`, and gives a chip whose writes it carries out, one
//     message each. What fails there comes back as the diagnostic that it is.
//  2. When the program ends in whatever way, or writes nothing for `silent_ms`, the process makes all lines inactive
//     and calls `drop`. After a silence every write fails.
//  3. Signals that a terminal or an init system sends to all processes neither end nor stop it: it ends when the program
//     has, or has released the chip. One that is killed or stopped by name is found out with the next write, within a
//     second: the lines are opened with `open` once more, here, are made inactive, and every write fails.
//  4. It must be started before any thread is.

#pragma once

#include <functional>
#include <memory>

#include "target/gpio/gpio_chip.h"

namespace lyr::run {

using OpenChip = std::function<Result<std::unique_ptr<gpio::GpioChip>>()>;

Result<std::unique_ptr<gpio::GpioChip>> keep_lines(std::size_t line_count, const OpenChip& open,
                                                   int silent_ms,
                                                   const std::function<void()>& drop = {});

}  // namespace lyr::run
