// What printer.toml says about the life of a print: buttons and sensors, pauses, changes of filament, recovery, the
// board's watchdog.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "target/config/heater.h"

namespace lyr::config {

// Lines that ask something of a print when they become active.
enum InputNumber : std::size_t {
    input_pause = 0,  // and resume
    input_cancel = 1,
    input_emergency = 2,
    input_filament = 3,  // it has run out
};
inline constexpr std::size_t input_count = 4;
inline constexpr std::array<std::string_view, input_count> input_names{"pause", "cancel",
                                                                       "emergency", "filament"};
using Inputs = std::array<std::optional<Pin>, input_count>;

// While the head rests. How fast is bounded by the axes, too.
struct PauseSettings {
    std::optional<std::array<double, 2>>
        park_mm;  // x and y; none: over the place where it left the path
    double lift_mm = 5;
    double retract_mm = 2;
    double speed_mm_s = 100;
    double tool_off_s = 600;    // a nozzle that waits for longer clogs
    double bed_off_s = 14'400;  // of bed and chamber: parts come loose when they cool
};

struct FilamentSettings {
    double unload_mm = 80;  // from the nozzle out of the drive of a direct extruder
    double load_mm = 80;
    double purge_mm = 30;  // until the new colour comes
    double speed_mm_s = 5;
};

struct WatchdogSettings {
    std::string device;  // empty: none
    double timeout_s = 15;
};

}  // namespace lyr::config
