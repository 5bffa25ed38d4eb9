// Watches one heater: whether what its sensor says can be true, and whether it does what it is told. Functions
// of samples and times alone, so that every one of them is tested by a list of samples.
//
// Contract. watch() takes one sample a tick and gives the first guard that it violates, or none:
//  1. sensor: open, shorted, unreadable, below the range or above it (over-temperature), bad_samples times in
//     a row; a good one in between starts the count anew.
//  2. rate: between readings half a second apart, each the middle one of three, more than rate_c_s.
//  3. heating too slow: while further than stray_c below the target, less than gain_c in gain_time_s. Another target
//     that is as far away sets that time back by nothing, and one that is not only stops it for less than gain_time_s.
//  4. falling: while heating so, stray_c below the highest reading since heating began, the first settle_s
//     left out, in which the sensor still tells of the time before.
//  5. stray: once the target was reached, more than stray_c below it for longer than stray_time_s.
//  6. stuck on: switched off for longer than settle_s, stray_c above the lowest reading since then. That mark follows
//     upwards by stray_c in stray_time_s, and 0.05 °C/s at the most: what a neighbour warms slowly is not stuck.
//     After heating it follows the rise of those settle_s, if that is more, less and less: a sensor that lags by half
//     of gain_time_s still has to tell of it.
//  7. frozen: a sensor's figure exactly the same for frozen_time_s while there is a target. Only the figure of a
//     converter that is fine and has noise never stands; asking_power() makes all others move.
//  Each fires in the first sample for which it is true, within a tick of its condition.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "target/config/heater.h"
#include "target/thermal/sensor.h"

namespace lyr::thermal {

inline constexpr int bad_samples = 4;
inline constexpr double settle_s = 10;

enum class GuardKind : std::uint8_t {
    open,
    shorted,
    unreadable,
    too_cold,
    over_temperature,
    rate,
    too_slow,
    falling,
    stray,
    stuck_on,
    frozen,
    silent,  // the control thread; power_stage.h
};

struct Trip {
    GuardKind kind = GuardKind::open;
    std::string message;  // which heater, what was measured, what to look at
};

struct Sample {
    double time_s = 0;
    std::optional<double> raw;  // none: the sensor could not be read
    Measured measured;
    double target_c = 0;  // 0: off
    double power = 0;     // that the heater was given up to now
};

enum class Phase : std::uint8_t { off, heating, holding };

// Between two samples of a heater.
struct GuardState {
    static constexpr std::size_t history =
        8;  // readings; three for the middle one, half a second before

    double target_c = 0;
    Phase phase = Phase::off;
    int bad = 0;                             // samples in a row
    std::array<double, history> readings{};  // the latest first
    std::array<double, history> times_s{};
    std::size_t reading_count = 0;
    double heating_since_s = 0;
    double goal_c = 0, goal_time_s = 0;  // to have gained by then
    std::optional<double> broken_off_s;  // when another target ended the heating,
    double goal_left_s = 0;              // and the time that it had left
    std::optional<double> highest_c;     // while heating
    std::optional<double> below_since_s;
    bool has_heated = false;
    std::optional<double> off_since_s;
    double off_from_c = 0;           // the reading then
    double lagging_c_s = 0;          // how fast it rose in the first settle_s
    std::optional<double> lowest_c;  // while off
    double last_time_s = 0;
    std::optional<double> same_raw;
    double same_since_s = 0;
};

std::optional<Trip> watch(const std::string& heater, const config::GuardLimits& limits,
                          GuardState& state, const Sample& sample);

// The power for a heater whose sensor's figure has been standing for half of frozen_time_s while the target is held: it
// may be dead, or too coarse to tell what little changes. Less and less than what the controller wants, or more and more
// where that is next to nothing, until the figure answers; by up to half of max_power.
double asking_power(double wanted, double max_power, const config::GuardLimits& limits,
                    const GuardState& state);

}  // namespace lyr::thermal
