// A swing lasts from one switching on to the next.

#include "target/thermal/tune.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>

namespace lyr::thermal {
namespace {

using std::numbers::pi;
// The powers never come closer to off or full than this, so that the heater still answers both ways.
constexpr double least_swing = 0.05;

config::Pid gains(double kp, double integral_time_s, double derivative_time_s) {
    return {kp, kp / integral_time_s, kp * derivative_time_s};
}

}  // namespace

RelayTune::RelayTune(double target_c, double max_power)
    : target_c_(target_c),
      max_power_(max_power),
      bias_(max_power / 2),
      swing_(max_power / 2),
      high_c_(target_c),
      low_c_(target_c) {}

double RelayTune::update(double time_s, double measured_c) {
    if (finished()) return 0;
    high_c_ = std::max(high_c_, measured_c);
    low_c_ = std::min(low_c_, measured_c);
    if (on_ && measured_c > target_c_ + hysteresis_c) {
        on_ = approaching_ = false;
        off_since_s_ = time_s;
        high_c_ = measured_c;
    } else if (!on_ && measured_c < target_c_ - hysteresis_c) {
        turn_on(time_s);
    }
    if (finished()) return 0;
    if (approaching_) return max_power_;
    return on_ ? bias_ + swing_ : bias_ - swing_;
}

void RelayTune::turn_on(double time_s) {
    // Of the swing that ends, if it was a whole one.
    if (on_since_s_ > 0) {
        const double rising_s = off_since_s_ - on_since_s_, falling_s = time_s - off_since_s_;
        const double height_c = (high_c_ - low_c_) / 2;
        ++swings_;
        if (swings_ > settling_swings) {
            flat_ = flat_ || !(height_c > hysteresis_c);
            gain_sum_ += 4 * swing_ / (pi * height_c);
            period_sum_s_ += rising_s + falling_s;
        } else {
            bias_ += swing_ * (rising_s - falling_s) / (rising_s + falling_s);
            bias_ = std::clamp(bias_, least_swing * max_power_, (1 - least_swing) * max_power_);
            swing_ = std::min(bias_, max_power_ - bias_);
        }
    }
    on_ = true;
    on_since_s_ = time_s;
    low_c_ = high_c_ = target_c_ - hysteresis_c;
}

std::optional<TuneResult> RelayTune::result() const {
    if (!finished() || flat_) return std::nullopt;
    TuneResult result;
    const double gain = result.ultimate_gain = gain_sum_ / measured_swings;
    const double period_s = result.ultimate_period_s = period_sum_s_ / measured_swings;
    result.ziegler_nichols = gains(0.6 * gain, period_s / 2, period_s / 8);
    result.tyreus_luyben = gains(gain / 2.2, 2.2 * period_s, period_s / 6.3);
    return result;
}

std::string text_of(const TuneResult& result, const std::string& heater) {
    std::array<char, 512> text{};
    const auto& [kp, ki, kd] = result.tyreus_luyben;
    const config::Pid& brisk = result.ziegler_nichols;
    std::snprintf(text.data(), text.size(),
                  "  swings of %.2f s, ultimate gain %.4f of full power for 1 °C\n"
                  "  for printer.toml (Tyreus-Luyben, little overshoot):\n"
                  "[heater.%s]\nkp = %.5f\nki = %.6f\nkd = %.4f\n"
                  "  or, brisker (Ziegler-Nichols): kp = %.5f, ki = %.6f, kd = %.4f\n",
                  result.ultimate_period_s, result.ultimate_gain, heater.c_str(), kp, ki, kd,
                  brisk.kp, brisk.ki, brisk.kd);
    return text.data();
}

}  // namespace lyr::thermal
