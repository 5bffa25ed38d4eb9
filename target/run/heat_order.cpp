// The state that orders change is kept where they are made, so that a layer that states what holds already
// makes none.

#include "target/run/heat_order.h"

#include <cstdio>

namespace lyr::run {

bool join(HeatOrder& order, const HeatOrder& next) {
    if (order.is_gate()) return false;
    for (std::size_t i = 0; i < order.targets_c.size(); ++i)
        if (next.targets_c[i]) order.targets_c[i] = next.targets_c[i];
    order.waits = next.waits;
    order.pause = next.pause;
    if (next.fan_duty) order.fan_duty = next.fan_duty;
    return true;
}

std::optional<std::size_t> heater_number(const format::Heater& heater) {
    switch (heater.kind) {
        case format::HeaterKind::bed:
            return config::heater_bed;
        case format::HeaterKind::chamber:
            return config::heater_chamber;
        case format::HeaterKind::tool:
            if (heater.tool == 0) return config::heater_tool;
            break;
    }
    return std::nullopt;
}

void HeatOrders::set(HeatOrder& order, const format::Heater& heater, double target_c, bool wait) {
    const std::optional<std::size_t> number = heater_number(heater);
    if (!number) return;
    if (targets_c_[*number] != target_c) order.targets_c[*number] = target_c;
    if (wait && target_c > 0) order.waits[*number] = true;
    targets_c_[*number] = target_c;
}

void HeatOrders::set(HeatOrder& order, const format::Fan& fan) {
    constexpr std::uint32_t part_fan = 0;
    if (fan.fan != part_fan || fan.duty == fan_duty_) return;
    order.fan_duty = fan_duty_ = fan.duty;
}

std::optional<HeatOrder> HeatOrders::take(const format::Operation& operation,
                                          const format::LayerState& layer) {
    HeatOrder order;
    if (std::holds_alternative<format::LayerStart>(operation)) {
        // A machine that starts with a layer waits for what it states; one that comes from the one before sets it.
        for (const format::HeaterTarget& target : layer.temperatures)
            set(order, target.heater, target.target_c, !begun_);
        for (const format::Fan& fan : layer.fans) set(order, fan);
        begun_ = true;
    } else if (const auto* temperature = std::get_if<format::Temperature>(&operation)) {
        set(order, temperature->heater, temperature->target_c, temperature->wait);
    } else if (const auto* fan = std::get_if<format::Fan>(&operation)) {
        set(order, *fan);
    } else if (const auto* pause = std::get_if<format::Pause>(&operation)) {
        order.pause = pause->reason;
    }
    const bool changes =
        order.fan_duty || order.targets_c[0] || order.targets_c[1] || order.targets_c[2];
    if (!changes && !order.is_gate()) return std::nullopt;
    return order;
}

std::optional<HeatOrder> OrderQueue::heed(const HeatOrder& order) const {
    HeatOrder rest;
    if (heeded_.heat) rest = order;
    rest.pause = heeded_.pauses ? order.pause : std::nullopt;
    if (!heeded_.heat && !rest.pause) return std::nullopt;
    return rest;
}

void OrderQueue::push(const HeatOrder& order) {
    const std::lock_guard lock(mutex_);
    orders_.push_back(order);
}

std::optional<HeatOrder> OrderQueue::pop() {
    const std::lock_guard lock(mutex_);
    if (orders_.empty()) return std::nullopt;
    const HeatOrder order = orders_.front();
    orders_.pop_front();
    return order;
}

bool HeatAttendant::is_done(const HeatOrder& order) const {
    for (std::size_t i = 0; i < order.waits.size(); ++i)
        if (order.waits[i] && !reached(i)) return false;
    return !order.pause || pause_is_over_;
}

void HeatAttendant::give_up(const HeatOrder& order) {
    for (std::size_t i = 0; i < order.waits.size(); ++i) {
        const thermal::HeaterStatus* status = control_ ? control_->status(i) : nullptr;
        if (!order.waits[i] || !status || reached(i)) continue;
        char text[300];
        std::snprintf(text, sizeof text,
                      "heater %s: %.1f °C after an hour of waiting for %g °C: is it strong enough, "
                      "and the room cool enough? All heaters are off and stay so until lyrrun is "
                      "started again",
                      std::string(config::heater_names[i]).c_str(), status->temperature_c,
                      status->target_c);
        return control_->stop({thermal::GuardKind::too_slow, text});
    }
}

void HeatAttendant::set(std::size_t heater, double target_c) {
    wanted_c_[heater] = target_c;
    if (control_) control_->set_target(heater, standby_[heater] ? 0 : target_c);
}

void HeatAttendant::carry_out(const HeatOrder& order) {
    for (std::size_t i = 0; i < order.targets_c.size(); ++i)
        if (const auto target_c = order.targets_c[i]) set(i, *target_c);
    if (order.fan_duty) fan_ = *order.fan_duty;
    if (order.fan_duty && control_) control_->set_fan(fan_);
    pause_is_over_ = false;
}

void HeatAttendant::heed(const HeatWish& wish) {
    standby_ = wish.standby;
    for (std::size_t i = 0; i < wanted_c_.size(); ++i)
        set(i, wish.targets_c[i].value_or(wanted_c_[i]));
    if (wish.fan) fan_ = *wish.fan;
    if (wish.fan && control_) control_->set_fan(fan_);
    pause_is_over_ = pause_is_over_ || wish.pause_is_over;
}

void HeatAttendant::tell() const {
    HeatNow now;
    now.reached = true;
    for (std::size_t i = 0; i < now.heaters.size(); ++i) {
        const thermal::HeaterStatus* status = control_ ? control_->status(i) : nullptr;
        if (status) now.heaters[i] = {true, status->temperature_c, status->target_c};
        const bool is_warmer = status && status->target_c > 0 &&
                               status->temperature_c > status->target_c + thermal::reached_c;
        now.reached = now.reached && (is_warmer || reached(i));
    }
    now.fan = fan_;
    now.waits = waiting_ && waiting_->is_gate() && !waiting_->pause;
    if (waiting_ && !pause_is_over_) now.pause = waiting_->pause;
    desk_->publish(now);
}

void HeatAttendant::tick() {
    if (desk_) heed(desk_->take());
    const std::uint32_t reached = marks_.reached.load(std::memory_order_acquire);
    std::uint32_t done = marks_.done.load(std::memory_order_relaxed);
    if (!on_standby()) ++waited_ticks_;
    while (done != reached && !on_standby()) {
        if (!waiting_) {
            waiting_ = orders_.pop();
            if (!waiting_) break;
            waited_ticks_ = 0;
            carry_out(*waiting_);
        }
        if (!is_done(*waiting_)) {
            if (!waiting_->pause && waited_ticks_ * thermal::tick_s > longest_wait_s)
                give_up(*waiting_);
            break;
        }
        waiting_.reset();
        marks_.done.store(++done, std::memory_order_release);
    }
    if (desk_) tell();
}

}  // namespace lyr::run
