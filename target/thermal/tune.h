// Finds a controller's gains by experiment (Astrom and Hagglund's relay): the heater is switched between two
// powers as the temperature passes the target, which makes it swing; the swing's height and period are those
// of a loop at the edge of stability.
//
// Contract
//  1. The power is from 0 to max_power, and off as soon as finished() is true.
//  2. The first swings are left out; the powers are shifted until rising and falling take about as long,
//     since the theory is of an even swing.
//  3. The result is the mean of the measured swings, or none if the swing is no larger than its hysteresis.

#pragma once

#include <optional>
#include <string>

#include "target/config/heater.h"

namespace lyr::thermal {

struct TuneResult {
    double ultimate_gain = 0;  // share of full power for 1 °C at the edge of stability
    double ultimate_period_s = 0;
    config::Pid ziegler_nichols;
    config::Pid tyreus_luyben;  // slower, with less overshoot
};

class RelayTune {
public:
    static constexpr double hysteresis_c = 0.5;
    static constexpr int settling_swings = 3, measured_swings = 5;

    RelayTune(double target_c, double max_power);
    // The power from here on.
    double update(double time_s, double measured_c);
    bool finished() const { return swings_ >= settling_swings + measured_swings; }
    int swings() const { return swings_; }
    std::optional<TuneResult> result() const;

private:
    void turn_on(double time_s);

    double target_c_, max_power_;
    double bias_, swing_;  // the powers are bias + swing and bias - swing
    bool on_ = true, approaching_ = true;
    double on_since_s_ = 0, off_since_s_ = 0;
    double high_c_, low_c_;
    int swings_ = 0;
    double gain_sum_ = 0, period_sum_s_ = 0;
    bool flat_ = false;  // a swing was too small to be one
};

// The lines of printer.toml.
std::string text_of(const TuneResult& result, const std::string& heater);

}  // namespace lyr::thermal
