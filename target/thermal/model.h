// What is heated, for the simulator: a heater, a block that loses heat to the room and to the part fan, and
// a sensor that lags behind. With the faults that a real one can have.
//
// Contract
//  1. A step of any length is the exact solution for constant power, but for the sensor, which follows the
//     block's temperature at the step's end.
//  2. The figure that raw() gives has a converter's noise of one count, from a fixed seed: the same run gives
//     the same figures.

#pragma once

#include <cstdint>
#include <optional>

#include "base/diagnostic.h"
#include "target/thermal/sensor.h"

namespace lyr::thermal {

inline constexpr double room_c = 21;

struct ModelFaults {
    bool open = false, shorted = false;  // of the sensor's wires
    bool detached = false;               // the sensor has fallen out
    bool frozen = false;                 // the converter repeats its last figure
    bool unreadable = false;             // the kernel's file gives an error
    bool stuck_on = false;               // the switch has burnt through
    double power_share = 1;              // of the heater's power that arrives; 0: burnt out
    double draught_w_k = 0;              // loss beyond the model's
    double jump_c = 0;                   // the sensor reads so much more than it should
};

class HeatedBody {
public:
    explicit HeatedBody(const config::Heater& heater)
        : model_(heater.model), scale_(heater.sensor) {}

    void advance(double time_s, bool on, double fan_share);
    // What the sensor's file holds now.
    Result<double> raw();

    ModelFaults& faults() { return faults_; }
    double body_c() const { return body_c_; }

private:
    double noise();

    config::HeatModel model_;
    SensorScale scale_;
    ModelFaults faults_;
    double body_c_ = room_c, sensor_c_ = room_c;
    std::uint32_t seed_ = 1;
    std::optional<double> last_raw_;
};

}  // namespace lyr::thermal
