#include "target/run/simulated_lines.h"

#include "target/run/executor_loop.h"

namespace lyr::run {

[[gnu::always_inline]] inline void SimulatedLines::decode(const gpio::LineWrite& write) {
    if (executor_ && executor_->on_trip()) return;
    const std::int64_t behind_ns = executor_ ? executor_->behind_ns() : 0;
    decoder_.write(write.time_ns - behind_ns, write.levels,
                   [this](const DecodedStep& step) { checks_.step(step); });
}

[[gnu::always_inline]] inline void SimulatedLines::Decoded::operator()(
    const gpio::LineWrite& write) const {
    lines->decode(write);
}

SimulatedLines::SimulatedLines(std::size_t line_count, const SimulatedClock& clock,
                               ChecksBeside& checks, gpio::MockChip::Fault fault)
    : checks_(checks), chip_(line_count, clock, Decoded{this}, std::move(fault)) {}

SimulatedLines::~SimulatedLines() = default;

void SimulatedLines::bind(Executor& executor) {
    executor.bind<gpio::MockLines<Decoded, SimulatedClock>, SimulatedClock>();
}

}  // namespace lyr::run
