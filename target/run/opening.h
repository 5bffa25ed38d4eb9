// What goes before the path of a print, such as homing, as others see it: it can be stopped, and tells its status. What
// else is asked for then waits for the path.
//
// Contract
//  1. asked() is a StopSource. A signal, a cancel and whatever else counts in the control's stop_requests() is a stop, an
//     emergency stop is one at once; none is taken from the control, which is served by who comes after.
//  2. Every look_s it calls `look` and publishes the status, whose place is unknown.

#pragma once

#include <functional>

#include "target/run/print_control.h"
#include "target/run/stop_signals.h"

namespace lyr::run {

class Opening {
public:
    static constexpr double look_s = 0.02;

    // `status`: what is known of the print. All must outlive it.
    Opening(PrintControl& control, HeatDesk& desk, const StopSignals& signals, PrintStatus status,
            std::function<void(double now_s)> look);

    unsigned asked();

private:
    void publish(double now_s);

    PrintControl& control_;
    HeatDesk& desk_;
    const StopSignals& signals_;
    PrintStatus status_;
    std::function<void(double)> look_;
    double begun_s_, next_s_ = 0;
    unsigned seen_ = 0;
};

}  // namespace lyr::run
