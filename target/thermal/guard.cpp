// One function a guard; each looks at the sample and its own part of the state.

#include "target/thermal/guard.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace lyr::thermal {
namespace {

using config::GuardLimits;

// Between the readings that the rate is taken from.
constexpr double rate_window_s = 0.5;

// Of gain_time_s: a sensor that lags by more could hardly show the gain in time.
constexpr double longest_lag = 0.5;

// A hotend over a warm bed gains 0.03 °C/s.
constexpr double neighbour_most_c_s = 0.05;

// What every message ends with.
constexpr const char* consequence =
    "; all heaters are off and stay so until lyrrun is started again";

std::optional<Trip> trip(GuardKind kind, const std::string& heater, const std::string& what) {
    return Trip{kind, "heater " + heater + ": " + what + consequence};
}

std::optional<GuardKind> bad_kind(const GuardLimits& limits, const Sample& sample) {
    if (!sample.raw) return GuardKind::unreadable;
    if (sample.measured.wiring == Wiring::open) return GuardKind::open;
    if (sample.measured.wiring == Wiring::shorted) return GuardKind::shorted;
    if (sample.measured.temperature_c < limits.low_c) return GuardKind::too_cold;
    if (sample.measured.temperature_c > limits.high_c) return GuardKind::over_temperature;
    return std::nullopt;
}

std::string bad_text(GuardKind kind, const GuardLimits& limits, const Sample& sample) {
    const double t = sample.measured.temperature_c, raw = sample.raw.value_or(0);
    switch (kind) {
        case GuardKind::open:
            return formatted("the sensor reads %g, full scale: a broken wire or a loose plug", raw);
        case GuardKind::shorted:
            return formatted("the sensor reads %g, nothing: a short circuit of its wires", raw);
        case GuardKind::too_cold:
            return formatted(
                "%.1f °C is below its range_c, which begins at %g: look at the sensor and its kind",
                t, limits.low_c);
        case GuardKind::over_temperature:
            return formatted(
                "%.1f °C is above its range_c, which ends at %g: look at the heater's switch, and "
                "at "
                "the sensor and its kind",
                t, limits.high_c);
        default:
            return "the sensor cannot be read: look at its wires and at the kernel's messages";
    }
}

double middle(double a, double b, double c) {
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

std::optional<Trip> check_rate(const std::string& heater, const GuardLimits& limits,
                               GuardState& state, const Sample& sample) {
    std::shift_right(state.readings.begin(), state.readings.end(), 1);
    std::shift_right(state.times_s.begin(), state.times_s.end(), 1);
    state.readings[0] = sample.measured.temperature_c;
    state.times_s[0] = sample.time_s;
    state.reading_count = std::min(state.reading_count + 1, GuardState::history);
    if (state.reading_count < GuardState::history) return std::nullopt;
    const auto& r = state.readings;
    const std::size_t last = GuardState::history - 1;
    const double change_c = middle(r[0], r[1], r[2]) - middle(r[last - 2], r[last - 1], r[last]);
    const double time_s = std::max(rate_window_s, state.times_s[1] - state.times_s[last - 1]);
    if (std::abs(change_c) <= limits.rate_c_s * time_s) return std::nullopt;
    return trip(
        GuardKind::rate, heater,
        formatted("the reading went by %.1f °C in %.1f s, to %.1f °C, which no heater does: look "
                  "at the sensor's plug, and whether it sits firmly",
                  change_c, time_s, r[0]));
}

void begin_heating(const GuardLimits& limits, GuardState& state, const Sample& sample) {
    const double t = sample.measured.temperature_c;
    const bool goes_on =
        state.broken_off_s && sample.time_s - *state.broken_off_s < limits.gain_time_s;
    state.highest_c.reset();
    state.heating_since_s = sample.time_s;
    state.goal_c = goes_on ? std::min(state.goal_c, t + limits.gain_c) : t + limits.gain_c;
    state.goal_time_s = sample.time_s + (goes_on ? state.goal_left_s : limits.gain_time_s);
}

void take_target(const GuardLimits& limits, GuardState& state, const Sample& sample) {
    const bool heated = state.phase == Phase::heating;
    const bool has_target = sample.target_c > 0;
    const bool heats =
        has_target && sample.measured.temperature_c < sample.target_c - limits.stray_c;
    state.target_c = sample.target_c;
    state.phase = heats ? Phase::heating : has_target ? Phase::holding : Phase::off;
    if (heats && !heated) begin_heating(limits, state, sample);
    if (heats || !heated) return;
    state.broken_off_s = sample.time_s;
    state.goal_left_s = state.goal_time_s - sample.time_s;
}

std::optional<Trip> check_heating(const std::string& heater, const GuardLimits& limits,
                                  GuardState& state, const Sample& sample) {
    const double t = sample.measured.temperature_c;
    if (t >= state.target_c - limits.stray_c) {
        state.phase = Phase::holding;
        state.broken_off_s.reset();
        return std::nullopt;
    }
    if (sample.time_s > state.heating_since_s + settle_s) {
        state.highest_c = std::max(state.highest_c.value_or(t), t);
        if (t < *state.highest_c - limits.stray_c)
            return trip(
                GuardKind::falling, heater,
                formatted("%.1f °C, after %.1f, and falling while it heats to %g °C: look "
                          "whether sensor and heater sit in the block, and at the heater's wires",
                          t, *state.highest_c, state.target_c));
    }
    if (t >= state.goal_c) {
        state.goal_c = t + limits.gain_c;
        state.goal_time_s = sample.time_s + limits.gain_time_s;
    } else if (sample.time_s >= state.goal_time_s) {
        return trip(
            GuardKind::too_slow, heater,
            formatted("%.1f °C on the way to %g °C, less than %g °C more than %g s ago: look at "
                      "the heater's wires and supply, and whether the sensor sits in the block",
                      t, state.target_c, limits.gain_c, limits.gain_time_s));
    }
    return std::nullopt;
}

std::optional<Trip> check_holding(const std::string& heater, const GuardLimits& limits,
                                  GuardState& state, const Sample& sample) {
    const double t = sample.measured.temperature_c;
    if (t >= state.target_c - limits.stray_c) {
        state.below_since_s.reset();
        return std::nullopt;
    }
    if (!state.below_since_s) state.below_since_s = sample.time_s;
    if (sample.time_s - *state.below_since_s <= limits.stray_time_s) return std::nullopt;
    return trip(
        GuardKind::stray, heater,
        formatted("%.1f °C, more than %g °C below its target of %g °C for more than %g s: look "
                  "at the heater's wires and supply, and at draughts",
                  t, limits.stray_c, state.target_c, limits.stray_time_s));
}

std::optional<Trip> check_off(const std::string& heater, const GuardLimits& limits,
                              GuardState& state, const Sample& sample) {
    const double t = sample.measured.temperature_c;
    if (sample.power > 0) {
        state.has_heated = true;
        state.off_since_s.reset();
        state.lowest_c.reset();
        return std::nullopt;
    }
    if (!state.off_since_s) {
        state.off_since_s = sample.time_s;
        state.off_from_c = t;
    }
    const double off_s = sample.time_s - *state.off_since_s;
    if (off_s < settle_s) return std::nullopt;
    if (!state.lowest_c)
        state.lagging_c_s = state.has_heated ? std::max(0.0, (t - state.off_from_c) / off_s) : 0;
    const double neighbour_c_s = std::min(neighbour_most_c_s, limits.stray_c / limits.stray_time_s);
    const double lag_c_s =
        state.lagging_c_s * std::exp((settle_s - off_s) / (longest_lag * limits.gain_time_s));
    const double follow_c = (sample.time_s - state.last_time_s) * std::max(neighbour_c_s, lag_c_s);
    state.lowest_c = std::min(t, state.lowest_c.value_or(t) + follow_c);
    if (t <= *state.lowest_c + limits.stray_c) return std::nullopt;
    return trip(
        GuardKind::stuck_on, heater,
        formatted("%.1f °C and rising, though it has been switched off for %.0f s: its switch is "
                  "stuck on; cut the power now, and look at the transistor or relay",
                  t, off_s));
}

std::optional<Trip> check_frozen(const std::string& heater, const GuardLimits& limits,
                                 GuardState& state, const Sample& sample) {
    if (!(sample.target_c > 0) || state.same_raw != sample.raw) {
        state.same_raw = sample.raw;
        state.same_since_s = sample.time_s;
    }
    if (sample.time_s - state.same_since_s < limits.frozen_time_s) return std::nullopt;
    return trip(
        GuardKind::frozen, heater,
        formatted(
            "the sensor has read exactly %g for %g s, whatever its heater was given: its "
            "converter is dead, or the kernel's driver is; raise its guard.frozen_time_s if the "
            "heater is too weak to move it by one step in that time",
            *sample.raw, limits.frozen_time_s));
}

}  // namespace

std::optional<Trip> watch(const std::string& heater, const GuardLimits& limits, GuardState& state,
                          const Sample& sample) {
    if (const auto bad = bad_kind(limits, sample)) {
        if (++state.bad < bad_samples) return std::nullopt;
        return trip(*bad, heater, bad_text(*bad, limits, sample));
    }
    state.bad = 0;
    std::optional<Trip> found = check_rate(heater, limits, state, sample);
    if (sample.target_c != state.target_c) take_target(limits, state, sample);
    if (!found && state.phase == Phase::heating)
        found = check_heating(heater, limits, state, sample);
    if (!found && state.phase == Phase::holding)
        found = check_holding(heater, limits, state, sample);
    if (!found) found = check_off(heater, limits, state, sample);
    if (!found) found = check_frozen(heater, limits, state, sample);
    state.last_time_s = sample.time_s;
    return found;
}

double asking_power(double wanted, double max_power, const GuardLimits& limits,
                    const GuardState& state) {
    const double half_s = limits.frozen_time_s / 2;
    const double asked_s = state.last_time_s - state.same_since_s - half_s;
    if (state.phase != Phase::holding || !(asked_s > 0)) return wanted;
    // Less is safer, but from less than a fifth there is too little to take.
    constexpr double enough_to_take = 0.2, most_moved = 0.5;
    const double moved = most_moved * max_power * std::min(1.0, asked_s / half_s);
    const double asked = wanted < enough_to_take * max_power ? wanted + moved : wanted - moved;
    return std::clamp(asked, 0.0, max_power);
}

}  // namespace lyr::thermal
