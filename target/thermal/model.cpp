// Two first-order lags in a row.

#include "target/thermal/model.h"

#include <cmath>

namespace lyr::thermal {

void HeatedBody::advance(double time_s, bool on, double fan_share) {
    const double power_w =
        model_.power_w * faults_.power_share * ((on || faults_.stuck_on) ? 1 : 0);
    const double loss_w_k = model_.loss_w_k + model_.fan_loss_w_k * fan_share + faults_.draught_w_k;
    const double final_c = room_c + power_w / loss_w_k;
    body_c_ = final_c + (body_c_ - final_c) * std::exp(-time_s * loss_w_k / model_.capacity_j_k);
    const double seen_c = faults_.detached ? room_c : body_c_;
    const double stays = model_.lag_s > 0 ? std::exp(-time_s / model_.lag_s) : 0;
    sensor_c_ = seen_c + (sensor_c_ - seen_c) * stays;
}

Result<double> HeatedBody::raw() {
    const config::Sensor& sensor = scale_.settings;
    // A kernel's driver that knows of broken wires, such as that of a MAX31855, gives an error for them.
    const bool tells = sensor.kind == config::SensorKind::celsius;
    if (faults_.unreadable || (tells && (faults_.open || faults_.shorted)))
        return Diagnostic{Severity::error,
                          ExitStatus::machine,
                          "cannot read the temperature: Input/output error",
                          {.file = sensor.file}};
    if (faults_.frozen && last_raw_) return *last_raw_;
    double raw = std::round(raw_of(scale_, sensor_c_ + faults_.jump_c) + noise());
    if (faults_.open) raw = sensor.full_scale;
    if (faults_.shorted) raw = 0;
    last_raw_ = raw;
    return raw;
}

// Even from -1 to 1 count (Numerical Recipes' generator).
double HeatedBody::noise() {
    seed_ = seed_ * 1664525u + 1013904223u;
    return static_cast<double>(seed_) / 2147483648.0 - 1;
}

}  // namespace lyr::thermal
