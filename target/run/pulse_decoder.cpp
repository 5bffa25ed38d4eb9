// Figures that did not occur are far from any time that a print takes.

#include "target/run/pulse_decoder.h"

namespace lyr::run {

PulseFigures PulseDecoder::figures(std::size_t axis) const {
    const AxisState& state = axes_[axis];
    const auto some = [](const Shortest& shortest) {
        return shortest.ns < none_ns ? std::optional(shortest.ns) : std::nullopt;
    };
    PulseFigures figures;
    figures.steps = state.steps;
    figures.reversals = state.reversals;
    figures.shortest_interval_ns = some(state.interval);
    if (state.longest_interval_ns >= 0) figures.longest_interval_ns = state.longest_interval_ns;
    figures.shortest_high_ns = some(state.high);
    figures.shortest_low_ns = some(state.low);
    figures.shortest_setup_ns = some(state.setup);
    figures.shortest_hold_ns = some(state.hold);
    return figures;
}

}  // namespace lyr::run
