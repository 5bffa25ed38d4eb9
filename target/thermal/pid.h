// From a temperature to a share of full power, and from a share to a line that is on or off.
//
// Contract
//  1. The power is from 0 to max_power, whatever the readings are.
//  2. No wind-up: while the output is at an end, the integral does not move further that way, and it never
//     holds more than an output can be.
//     Gains mean the same however long it was since the last reading.
//  3. A step of the target makes no kick of the derivative, which is that of the (smoothed) reading.
//  4. SlowPwm is on for its share of each cycle of whole ticks; what a cycle rounds off, the next ones make
//     good. Power 0 switches off at once, in the middle of a cycle too.

#pragma once

#include "target/config/heater.h"

namespace lyr::thermal {

// How often sensors are read, controllers work and lines are switched.
inline constexpr double tick_s = 0.1;

class PidController {
public:
    // The smoothing of the derivative: a converter's noise of a tenth of a degree must not switch the heater.
    static constexpr double smoothing_s = 1;

    PidController(const config::Pid& gains, double max_power)
        : gains_(gains), max_power_(max_power) {}

    // `passed_s` since the last one; a target of 0 or less is off.
    double update(double target_c, double measured_c, double passed_s = tick_s);

private:
    config::Pid gains_;
    double max_power_;
    double integral_ = 0;
    double smooth_c_ = 0;
    bool begun_ = false;
};

class SlowPwm {
public:
    explicit SlowPwm(double cycle_s);
    // For the tick that begins.
    bool next(double share);

private:
    int cycle_ticks_;
    int tick_ = 0, on_ticks_ = 0;
    double rest_ticks_ = 0;  // that the cycles so far still owe
};

}  // namespace lyr::thermal
