// Guards see the reading before the controller does.

#include "target/thermal/control.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace lyr::thermal {

HeatControl::HeatControl(std::vector<HeaterPort> heaters, bool has_fan, PowerStage& stage)
    : has_fan_(has_fan), stage_(stage) {
    for (HeaterPort& port : heaters) {
        SensorScale scale(port.settings.sensor);
        PidController pid(port.settings.pid, port.settings.max_power);
        channels_.push_back({std::move(port), std::move(scale), pid, {}, {}, 0});
    }
    shares_.resize(channels_.size() + (has_fan ? 1 : 0));
}

const HeatControl::Channel* HeatControl::find(std::size_t number) const {
    for (const Channel& channel : channels_)
        if (channel.port.number == number) return &channel;
    return nullptr;
}

void HeatControl::set_target(std::size_t number, double target_c) {
    if (trip_) return;
    for (Channel& channel : channels_) {
        if (channel.port.number != number || channel.status.target_c == target_c) continue;
        channel.status.target_c = target_c;
        channel.near_s = 0;
    }
}

void HeatControl::tune(std::size_t number, const RelayTune& relay) {
    relay_ = relay;
    relay_number_ = number;
}

void HeatControl::tick(double time_s) {
    const double passed_s = std::max(0.0, time_s - ticked_s_.value_or(time_s - tick_s));
    ticked_s_ = time_s;
    for (Channel& channel : channels_) {
        if (trip_) break;
        sample(channel, time_s, passed_s);
        if (!trip_) control(channel, time_s, passed_s);
    }
    // After a trip, too: fans go on with their pulses.
    for (std::size_t i = 0; i < channels_.size(); ++i) shares_[i] = channels_[i].status.power;
    if (has_fan_) shares_.back() = fan_;
    if (const Status applied = stage_.apply(shares_, time_s); !applied)
        stop({GuardKind::silent, "the heaters cannot be switched: " + applied.error().message});
}

void HeatControl::stop(Trip trip) {
    if (trip_) return;
    trip_ = std::move(trip);
    (void)stage_.all_off();
    for (Channel& channel : channels_) channel.status.target_c = channel.status.power = 0;
}

void HeatControl::sample(Channel& channel, double time_s, double passed_s) {
    const config::Heater& settings = channel.port.settings;
    HeaterStatus& status = channel.status;
    const Result<double> raw = channel.port.sensor->read();
    Sample sample;
    sample.time_s = time_s;
    sample.target_c = status.target_c;
    sample.power = status.power;
    if (raw) {
        sample.raw = *raw;
        sample.measured = measure(channel.scale, *raw);
    }
    const std::string name(config::heater_names[channel.port.number]);
    if (std::optional<Trip> found = watch(name, settings.guard, channel.guard, sample))
        return stop(std::move(*found));
    // A bad figure is not worked with; the guard has counted it.
    if (channel.guard.bad > 0) return;
    status.temperature_c = sample.measured.temperature_c;
    status.highest_c = std::max(status.highest_c, status.temperature_c);
    check_extrusion(channel);
    const bool near = std::abs(status.temperature_c - status.target_c) <= reached_c;
    channel.near_s = near ? channel.near_s + passed_s : 0;
}

void HeatControl::check_extrusion(const Channel& channel) {
    const HeaterStatus& status = channel.status;
    const config::Heater& settings = channel.port.settings;
    const double least_c = settings.min_extrude_c;
    const bool may_push = channel.port.number == config::heater_tool &&
                          channel.guard.phase == Phase::holding && status.target_c >= least_c;
    // A target at the limit itself may be strayed from like any other.
    const double limit_c = std::min(least_c, status.target_c - settings.guard.stray_c);
    if (!may_push || status.temperature_c >= limit_c) return;
    char text[300];
    std::snprintf(text, sizeof text,
                  "heater tool: %.1f °C, colder than heater.tool.min_extrude_c = %g, though it had "
                  "reached %g °C: "
                  "look at the heater's wires and supply, and at draughts; all heaters are off and "
                  "stay so until lyrrun is started again",
                  status.temperature_c, least_c, status.target_c);
    stop({GuardKind::falling, text});
}

void HeatControl::control(Channel& channel, double time_s, double passed_s) {
    HeaterStatus& status = channel.status;
    const bool tunes = relay_ && relay_number_ == channel.port.number;
    const config::Heater& settings = channel.port.settings;
    status.power =
        tunes ? relay_->update(time_s, status.temperature_c)
              : asking_power(channel.pid.update(status.target_c, status.temperature_c, passed_s),
                             settings.max_power, settings.guard, channel.guard);
    // While its sensor gives bad figures, a heater stays off.
    if (channel.guard.bad > 0) status.power = 0;
    status.on_s += status.power * passed_s;
}

bool HeatControl::reached(std::size_t number) const {
    if (trip_) return false;
    const Channel* channel = find(number);
    return !channel || !(channel->status.target_c > 0) || channel->near_s >= reached_s;
}

const HeaterStatus* HeatControl::status(std::size_t number) const {
    const Channel* channel = find(number);
    return channel ? &channel->status : nullptr;
}

}  // namespace lyr::thermal
