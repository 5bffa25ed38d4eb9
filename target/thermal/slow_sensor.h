// A sensor that takes long to read, such as one on a 1-wire bus (0.75 s), read by a thread of its own: no heater waits
// for another one's sensor.
//
// Contract
//  1. unhurried() reads once and leaves a sensor that answers within quick_s as it is. One that takes longer than
//     slowest_s is refused: no guard could act in time.
//  2. Of any other, read() gives at once what the last reading that has ended gave, figure or diagnostic. Its thread
//     starts with the first read().
//  3. When no reading has ended for oldest_s, read() is a diagnostic.
//  4. The destructor does not wait for a reading that hangs: the thread ends after it.

#pragma once

#include "target/thermal/sensor.h"

namespace lyr::thermal {

// Of a tick there is much else to do in.
inline constexpr double quick_s = 0.025;
// 1-wire in 12 bits takes 0.75 s and what the bus needs.
inline constexpr double slowest_s = 1;
// Two sensors on one bus that have to wait for each other, and less than what is silent.
inline constexpr double oldest_s = 2;

Result<std::unique_ptr<TemperatureSensor>> unhurried(std::unique_ptr<TemperatureSensor> sensor);

}  // namespace lyr::thermal
