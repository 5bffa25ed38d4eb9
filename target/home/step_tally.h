// Lines around others that remember where the motors were at which time, so that an edge that becomes known late still
// has its step.
//
// Contract
//  1. All calls are passed on; a rising edge of a step line counts one microstep in the direction of that axis's
//     direction line. A write that fails is not counted.
//  2. counts_at(t) are the counts after the last write that was not later than t; none if that is more than `remembered`
//     writes with steps ago.
//  3. Nothing is allocated in write(). One thread writes; others look when it has ended.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "target/gpio/clock.h"
#include "target/motion/step_generator.h"
#include "target/run/line_layout.h"

namespace lyr::home {

class StepTally final : public gpio::GpioChip {
public:
    // More than a motor makes from a contact until it has come to rest: 0.3 s of 100,000 steps/s.
    static constexpr std::size_t remembered = std::size_t{1} << 15;

    StepTally(gpio::GpioChip& inner, const gpio::Clock& clock)
        : inner_(inner), clock_(clock), begin_ns_(clock.now_ns()), seen_(remembered) {}

    std::size_t line_count() const override { return inner_.line_count(); }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override;
    Status release() override { return inner_.release(); }

    const motion::StepCounts& counts() const { return counts_; }
    std::optional<motion::StepCounts> counts_at(std::int64_t time_ns) const;

private:
    static constexpr int edge_bits = 8;
    static_assert((run::all_step_bits | run::all_direction_bits) >> edge_bits == 0);

    gpio::GpioChip& inner_;
    const gpio::Clock& clock_;
    std::int64_t begin_ns_;
    gpio::LineMask levels_ = 0;
    motion::StepCounts counts_{};
    // A ring. Of each write with steps its time since the begin, good for 833 days, and in the lowest bits the steps that
    // it made and the directions that they had.
    std::vector<std::uint64_t> seen_;
    std::size_t writes_ = 0;
};

}  // namespace lyr::home
