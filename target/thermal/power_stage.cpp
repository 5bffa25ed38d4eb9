// Off is tried on every output, whatever the ones before it answered.

#include "target/thermal/power_stage.h"

#include <algorithm>
#include <utility>

namespace lyr::thermal {

Status PowerStage::apply(std::span<const double> shares, double time_s) {
    const std::lock_guard lock(mutex_);
    refreshed_s_ = time_s;
    shares_.assign(shares.begin(), shares.end());
    if (latched_)
        for (std::size_t i = 0; i < outputs_.size(); ++i)
            if (outputs_[i].heats) shares_[i] = 0;
    Status switched = switch_all(shares_);
    if (!switched) (void)latch();
    return switched;
}

Status PowerStage::switch_all(std::span<const double> shares) {
    Status result = Done{};
    gpio::LineMask changed = 0, levels = 0;
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
        Status set = Done{};
        if (auto* line = std::get_if<LineOutput>(&outputs_[i].way)) {
            changed |= gpio::line_bit(line->line);
            if (line->pwm.next(shares[i])) levels |= gpio::line_bit(line->line);
        } else {
            set = std::get<KernelPwm>(outputs_[i].way).set(shares[i]);
        }
        if (!set && result) result = std::move(set);
    }
    // Where no output is a line, too: whoever keeps the chip hears that all is well.
    if (!chip_) return result;
    Status written = chip_->write(changed, levels);
    return result ? std::move(written) : std::move(result);
}

Status PowerStage::latch() {
    latched_ = true;
    shares_.resize(outputs_.size());
    for (std::size_t i = 0; i < outputs_.size(); ++i)
        if (outputs_[i].heats) shares_[i] = 0;
    return switch_all(shares_);
}

Status PowerStage::all_off() {
    const std::lock_guard lock(mutex_);
    return latch();
}

std::optional<Trip> PowerStage::expire(double time_s) {
    const std::lock_guard lock(mutex_);
    // A sensor may hang in the very first tick.
    if (!refreshed_s_) refreshed_s_ = time_s;
    if (latched_ || time_s - *refreshed_s_ <= silent_s) return std::nullopt;
    (void)latch();
    return Trip{GuardKind::silent,
                "the control of the heaters has been silent for more than 3 s: a sensor's file "
                "that hangs, or a board that is overloaded; all heaters are off and stay so until "
                "lyrrun is started again"};
}

Status PowerStage::release() {
    const std::lock_guard lock(mutex_);
    latched_ = true;
    const std::vector<double> none(outputs_.size(), 0.0);
    Status off = switch_all(none);
    if (!chip_) return off;
    Status released = std::exchange(chip_, nullptr)->release();
    return off ? std::move(released) : std::move(off);
}

bool PowerStage::latched() const {
    const std::lock_guard lock(mutex_);
    return latched_;
}

}  // namespace lyr::thermal
