// Finds a heater's gains on the machine itself, or on its model.
//
// Contract
//  1. All guards watch; one that fires ends the tuning with its message (status machine). SIGINT, SIGTERM and SIGHUP
//     end it with status stopped. However it ends, all heaters are off and released.
//     So does the emergency line, and a heater that does not swing about the target for half an hour.
//  2. A target below 30 °C, or within headroom_c of the end of the heater's range is refused, as is a heater that the
//     printer does not have.

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "target/config/printer.h"
#include "target/thermal/faults.h"
#include "target/thermal/tune.h"

namespace lyr::run {

struct TuneProgress {
    double time_s = 0, temperature_c = 0;
    int swings = 0, of = 0;
};

struct TuneJob {
    config::Printer printer;
    std::size_t heater = 0;  // of config
    double target_c = 0;
    bool simulate = false;
    std::vector<thermal::Fault> faults{};  // of a simulation
    std::function<void(const TuneProgress&)> progress{};
};

Result<thermal::TuneResult> tune(const TuneJob& job);

}  // namespace lyr::run
