// The outputs of heaters and fans: slow pulses on lines, or kernel PWM channels. The one place that switches
// heat, and so the one that can take it away whatever became of the thread that controls it.
//
// Contract
//  1. apply() gives each output its share of power for the tick that begins. Lines that change leave in one
//     write; the call refreshes all outputs.
//  2. all_off() switches every heater off in one write and latches: nothing switches a heater on again. Fans keep
//     what they have: they cool.
//  3. expire() does so if nobody has refreshed the outputs for silent_s, or since it was first called, and says so; it
//     may be called from another thread than apply(), as all of this.
//  4. A write that fails is a diagnostic of apply(), and latches too.
//  5. release() makes all lines inactive and hands them back; so does the destructor.

#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "target/gpio/gpio_chip.h"
#include "target/thermal/guard.h"
#include "target/thermal/kernel_pwm.h"
#include "target/thermal/pid.h"

namespace lyr::thermal {

// Nobody may be silent for longer.
inline constexpr double silent_s = 3;

struct LineOutput {
    std::size_t line = 0;  // of the chip
    SlowPwm pwm;
};

struct Output {
    std::variant<LineOutput, KernelPwm> way;
    bool heats = true;  // false: a fan
};

class PowerStage {
public:
    // The chip may be null if no output is a line.
    PowerStage(std::vector<Output> outputs, gpio::GpioChip* chip)
        : outputs_(std::move(outputs)), chip_(chip) {}
    ~PowerStage() { (void)release(); }
    PowerStage(const PowerStage&) = delete;
    PowerStage& operator=(const PowerStage&) = delete;

    Status apply(std::span<const double> shares, double time_s);
    Status all_off();
    std::optional<Trip> expire(double time_s);
    Status release();
    bool latched() const;

private:
    Status switch_all(std::span<const double> shares);
    Status latch();

    mutable std::mutex mutex_;
    std::vector<Output> outputs_;
    gpio::GpioChip* chip_;
    std::optional<double> refreshed_s_;
    std::vector<double> shares_;
    bool latched_ = false;
};

}  // namespace lyr::thermal
