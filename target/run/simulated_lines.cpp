#include "target/run/simulated_lines.h"

#include "target/run/executor_loop.h"

namespace lyr::run {

[[gnu::always_inline]] inline void SimulatedLines::Decoded::operator()(
    const gpio::LineWrite& write) const {
    const Executor* executor = lines->executor_;
    if (executor && executor->on_trip()) return;
    const std::int64_t behind_ns = executor ? executor->behind_ns() : 0;
    lines->decoder_.write(write.time_ns - behind_ns, write.levels,
                          [this](const DecodedStep& step) { lines->checks_.step(step); });
}

SimulatedLines::SimulatedLines(std::size_t line_count, const SimulatedClock& clock,
                               ChecksBeside& checks, gpio::MockChip::Fault fault)
    : checks_(checks), chip_(line_count, clock, Decoded{this}, std::move(fault)) {}

SimulatedLines::~SimulatedLines() = default;

void SimulatedLines::bind(Executor& executor) {
    executor.bind<gpio::MockLines<Decoded, SimulatedClock>, SimulatedClock>();
}

}  // namespace lyr::run
