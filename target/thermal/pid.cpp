// The textbook's parallel form, with what makes it fit for heaters: one sign only, and no wind-up.

#include "target/thermal/pid.h"

#include <algorithm>
#include <cmath>

namespace lyr::thermal {

double PidController::update(double target_c, double measured_c, double passed_s) {
    if (!begun_) smooth_c_ = measured_c;
    begun_ = true;
    const double slope_c_s = (measured_c - smooth_c_) / (smoothing_s + passed_s);
    smooth_c_ += slope_c_s * passed_s;
    if (!(target_c > 0) || !std::isfinite(measured_c)) {
        integral_ = 0;
        return 0;
    }
    const double error_c = target_c - measured_c;
    const double direct = gains_.kp * error_c - gains_.kd * slope_c_s;
    const double integral = integral_ + gains_.ki * error_c * passed_s;
    const double wanted = direct + integral;
    const bool winds_up = (wanted > max_power_ && error_c > 0) || (wanted < 0 && error_c < 0);
    if (!winds_up) integral_ = std::clamp(integral, 0.0, max_power_);
    return std::clamp(direct + integral_, 0.0, max_power_);
}

SlowPwm::SlowPwm(double cycle_s)
    : cycle_ticks_(std::max(1, static_cast<int>(std::lround(cycle_s / tick_s)))) {}

bool SlowPwm::next(double share) {
    if (!(share > 0)) {
        tick_ = on_ticks_ = 0;
        rest_ticks_ = 0;
        return false;
    }
    if (tick_ == 0) {
        const double due_ticks = std::min(share, 1.0) * cycle_ticks_ + rest_ticks_;
        on_ticks_ = std::clamp(static_cast<int>(std::lround(due_ticks)), 0, cycle_ticks_);
        rest_ticks_ = due_ticks - on_ticks_;
    }
    const bool on = tick_ < on_ticks_;
    tick_ = (tick_ + 1) % cycle_ticks_;
    return on;
}

}  // namespace lyr::thermal
