// What of a sensor's keys does not go together, with each other and with the heater that it watches. Private to this
// room.
//
// Contract
//  1. Of a heater that passes, the sensor reads a temperature from a cold one up to the end of range_c: neither an open
//     nor a shorted one, no step of its converter worth more than the guards allow it to stray.

#pragma once

#include <string>

#include "target/config/machine_keys.h"

namespace lyr::config {

// `section` is the heater's, "heater.bed".
void append_sensor_problems(const std::string& section, const Heater& heater, const Given& given,
                            Problems& problems);

}  // namespace lyr::config
