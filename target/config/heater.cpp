// Guards as in the field's firmwares; controllers as measured on common hotends and beds, which serve until
// the owner's own are tuned.

#include "target/config/heater.h"

namespace lyr::config {
namespace {

Heater hotend() {
    Heater heater;
    // A small block answers fast, and its switch is a transistor.
    heater.cycle_s = 0.5;
    // A 40 W cartridge in an aluminium block: 22.2, 1.08 and 114 of 255.
    heater.pid = {0.087, 0.0042, 0.447};
    return heater;
}

Heater bed() {
    Heater heater;
    heater.pid = {0.212, 0.003, 3.72};
    heater.guard = {.low_c = 0,
                    .high_c = 130,
                    .gain_c = 2,
                    .gain_time_s = 60,
                    .stray_c = 2,
                    .stray_time_s = 20,
                    .rate_c_s = 20,
                    .frozen_time_s = 60};
    heater.model = {
        .power_w = 220, .capacity_j_k = 700, .loss_w_k = 1.3, .fan_loss_w_k = 0.1, .lag_s = 3};
    return heater;
}

// The air of an enclosure follows slowly and strays when the door opens.
Heater chamber() {
    Heater heater;
    heater.pid = {0.2, 0.0005, 0};
    heater.guard = {.low_c = 0,
                    .high_c = 80,
                    .gain_c = 1,
                    .gain_time_s = 180,
                    .stray_c = 8,
                    .stray_time_s = 300,
                    .rate_c_s = 20,
                    .frozen_time_s = 600};
    heater.model = {
        .power_w = 150, .capacity_j_k = 3'000, .loss_w_k = 2, .fan_loss_w_k = 0, .lag_s = 10};
    return heater;
}

}  // namespace

Heater default_heater(std::size_t number) {
    switch (number) {
        case heater_bed:
            return bed();
        case heater_chamber:
            return chamber();
        default:
            return hotend();
    }
}

}  // namespace lyr::config
