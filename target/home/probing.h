// Finds how high the bed is at places, with the probe.
//
// Contract
//  1. touch_bed() brings the probe over a place at a safe height, approaches fast and then `samples` times slowly, and
//     gives where the head was, on the average, when the probe triggered. Afterwards the head is lift_mm above.
//  2. Errors (status machine): a place that the probe cannot reach, a probe that is triggered before it goes down or
//     stays so, that does not trigger down to reach_mm below the bed, or whose approaches differ by more than
//     tolerance_mm.

#pragma once

#include "target/home/touch.h"

namespace lyr::home {

// A place on the bed.
struct Spot {
    double x_mm = 0, y_mm = 0;
};

// Where the probe homes z, and is calibrated.
Spot probe_spot(const config::Printer& printer);

// `machine` is that of bare_machine(), homed, its nozzle at a safe height.
Result<ByAxes::Positions> touch_bed(ByAxes& machine, const config::Printer& printer,
                                    const Spot& spot);

}  // namespace lyr::home
