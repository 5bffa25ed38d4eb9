// A board's heaters where there is no print: ticked by the one thread that uses them, which looks after signals and the
// emergency line at the same time.
//
// Contract
//  1. tick() takes about tick_ms. Once it has said why it is over (status machine, or stopped on request), all
//     heaters are off.
//  2. A thread that hangs at a sensor loses its heat, too. The destructor switches all off and lets go of it.

#pragma once

#include <memory>
#include <thread>

#include "target/run/buttons.h"
#include "target/run/heating.h"
#include "target/run/stop_signals.h"

namespace lyr::run {

class TendedHeat {
public:
    static constexpr int tick_ms = 100;

    // Before any thread is started. Errors: those of open_heating() and open_buttons().
    static Result<std::unique_ptr<TendedHeat>> open(const config::Printer& printer);

    thermal::HeatControl& control() { return *heating_.control; }
    // None: all is well.
    std::optional<Diagnostic> tick();

private:
    TendedHeat() = default;

    StopSignals signals_;
    Heating heating_;
    std::optional<Buttons> buttons_;
    std::jthread watch_;
};

}  // namespace lyr::run
