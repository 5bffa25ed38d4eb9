// The heaters of a board: sensors, outputs, control, and the thread that tends them.
//
// Contract
//  1. open_heating() names the key that is missing, or the file or line that cannot be had (status machine); then
//     nothing is held.
//     Lines are held and PWM channels watched by a process of their own (line_keeper.h), so that a crash leaves no heater
//     on; it must be called before any thread is started.
//     Nor may two keys lead to one channel or sensor, by whatever paths: of two that share a channel one would be heated by
//     the other's power.
//  2. tend() ticks until `finished`, on its own thread, and counts the ticks; a tick that takes long makes no others
//     hurry.
//  3. The first guard that fires is told once, through `tripped`, from whichever thread finds it.
//  4. switch_off() makes all lines of heaters and motors inactive and empties the heaters' PWM channels, for prints
//     that were killed, whoever has locked them. Where a line cannot be had, as that of a print at work, nothing is touched.

#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/gpio_chip.h"
#include "target/run/heat_order.h"
#include "target/thermal/control.h"

namespace lyr::run {

// Parts of it refer to each other by address.
struct Heating {
    std::unique_ptr<gpio::GpioChip> chip;  // none: there is nothing to heat
    std::unique_ptr<thermal::PowerStage> stage;
    std::unique_ptr<thermal::HeatControl> control;
};

// A key, and what is wrong with what it names.
using KeyProblem = std::pair<std::string, std::string>;
// Keys that lead to one channel or sensor by different paths; all are looked for below `root`.
std::vector<KeyProblem> shared_files(const config::Printer& printer, const std::string& root);

Result<Heating> open_heating(const config::Printer& printer);

using OpenLines =
    std::function<Result<std::unique_ptr<gpio::GpioChip>>(std::span<const gpio::LineRequest>)>;
Status switch_off(const config::Printer& printer, const OpenLines& open);

// On the clock that tend() and the looks of others at PowerStage::expire() share.
double heat_time_s();

void tend(thermal::HeatControl& control, HeatAttendant& attendant,
          const std::atomic<bool>& finished, std::atomic<std::uint32_t>& ticks,
          const std::function<void(const thermal::Trip&)>& tripped);

Diagnostic diagnostic_of(const thermal::Trip& trip);

}  // namespace lyr::run
