// Reads step and direction lines as a motor driver does: each rising edge of a step line moves the axis
// by one step in the direction that the direction line has at that moment. Knows nothing of how the
// edges came about, and so can judge them.
//
// Contract
//  1. Positions count from 0 at the first write; +1 for a rising edge under an active direction line,
//     -1 under an inactive one.
//  2. Every step is told to the observer once, in order of time; steps of one write in order of axes.
//     Lines that change in the same write as the direction line see it as it was before.
//  3. The figures of an axis are the extremes over all that was written. What did not occur is none.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "target/gpio/mock_chip.h"
#include "target/run/line_layout.h"

namespace lyr::run {

using StepPositions = std::array<std::int64_t, config::axis_count>;

struct DecodedStep {
    std::int64_t time_ns = 0;
    std::size_t axis = 0;
    const StepPositions& before;
    bool positive = true;
};

// Of one axis.
struct PulseFigures {
    std::uint64_t steps = 0;
    std::uint64_t reversals = 0;
    std::optional<std::int64_t> shortest_interval_ns, longest_interval_ns;  // rise to rise
    std::optional<std::int64_t> shortest_high_ns, shortest_low_ns;
    std::optional<std::int64_t> shortest_setup_ns, shortest_hold_ns;
};

class PulseDecoder {
public:
    using Observer = std::function<void(const DecodedStep&)>;

    explicit PulseDecoder(Observer observer) : observer_(std::move(observer)) {}
    void write(const gpio::LineWrite& write);

    const StepPositions& positions() const { return positions_; }
    const PulseFigures& figures(std::size_t axis) const { return axes_[axis].figures; }
    std::uint64_t writes() const { return writes_; }

private:
    struct AxisState {
        PulseFigures figures;
        std::optional<std::int64_t> rise_ns, fall_ns, turn_ns;
        bool hold_open = false;  // no turn since the last rise
        std::optional<bool> last_positive;
    };

    void rise(std::size_t axis, std::int64_t time_ns);
    void fall(AxisState& state, std::int64_t time_ns);
    void turn(AxisState& state, std::int64_t time_ns);

    Observer observer_;
    gpio::LineMask levels_ = 0;
    StepPositions positions_{};
    std::array<AxisState, config::axis_count> axes_;
    std::uint64_t writes_ = 0;
};

}  // namespace lyr::run
