// The lines of a simulation: mock lines whose writes are decoded, and whose steps go to the checks. What is done for each
// edge, the executor's part included, is made here without a virtual call.
//
// Contract
//  1. While the executor is on a trip nothing is decoded. Waits, rests and what the head does meanwhile are no part of the
//     plan: times are those of the path's events.

#pragma once

#include "target/gpio/mock_chip.h"
#include "target/run/checks_beside.h"
#include "target/run/executor.h"
#include "target/run/pulse_decoder.h"
#include "target/run/simulated_clock.h"

namespace lyr::run {

class SimulatedLines {
public:
    SimulatedLines(std::size_t line_count, const SimulatedClock& clock, ChecksBeside& checks,
                   gpio::MockChip::Fault fault);
    ~SimulatedLines();

    gpio::GpioChip& chip() { return chip_; }
    // Whose writes these are; none: the chip's own, which are made when it is released.
    void belong_to(const Executor* executor) { executor_ = executor; }
    // To this chip and the clock, of an executor that writes on them itself.
    static void bind(Executor& executor);
    const PulseDecoder& decoder() const { return decoder_; }

private:
    struct Decoded {
        SimulatedLines* lines;
        explicit operator bool() const { return true; }
        void operator()(const gpio::LineWrite& write) const;
    };

    ChecksBeside& checks_;
    PulseDecoder decoder_;
    const Executor* executor_ = nullptr;
    gpio::MockLines<Decoded, SimulatedClock> chip_;
};

}  // namespace lyr::run
