#include "target/run/heat_desk.h"

namespace lyr::run {

void HeatDesk::set_target(std::size_t heater, double target_c) {
    const std::lock_guard lock(mutex_);
    wish_.targets_c[heater] = target_c;
    ++asked_;
}

void HeatDesk::set_fan(double duty) {
    const std::lock_guard lock(mutex_);
    wish_.fan = duty;
}

void HeatDesk::set_standby(const std::array<bool, config::heater_count>& standby) {
    const std::lock_guard lock(mutex_);
    wish_.standby = standby;
    ++asked_;
}

void HeatDesk::end_pause() {
    const std::lock_guard lock(mutex_);
    wish_.pause_is_over = true;
    now_.pause.reset();
}

HeatNow HeatDesk::now() const {
    const std::lock_guard lock(mutex_);
    return now_;
}

bool HeatDesk::has_seen() const {
    const std::lock_guard lock(mutex_);
    return seen_ == asked_;
}

bool HeatDesk::settled() const {
    const std::lock_guard lock(mutex_);
    return seen_ == asked_ && now_.reached;
}

HeatWish HeatDesk::take() {
    const std::lock_guard lock(mutex_);
    const HeatWish wish = wish_;
    wish_ = {};
    wish_.standby = wish.standby;
    taken_ = asked_;
    return wish;
}

void HeatDesk::publish(const HeatNow& now) {
    const std::lock_guard lock(mutex_);
    const bool is_over = wish_.pause_is_over;
    now_ = now;
    seen_ = taken_;
    if (is_over) now_.pause.reset();
}

}  // namespace lyr::run
