// Holds decoded steps against the plan in time, for all machines: where the motors are against where the plan wants them.
//
// Contract
//  1. off_plan() is the largest distance, in a motor's steps, between the planned position and the one decoded, just
//     before and after each of its steps and at looks_per_move times of each move.
//  2. A motor with play carries its axis only where it has turned by the play; what is measured is the axis.
//  3. Steps without a plan for their time show as a deviation.

#pragma once

#include <deque>

#include "target/run/pulse_decoder.h"
#include "target/run/pulse_schedule.h"
#include "target/run/shaped_plan.h"

namespace lyr::run {

class TimedCheck {
public:
    static constexpr int looks_per_move = 8;

    explicit TimedCheck(const config::Printer& printer);

    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step);
    void finish(const StepPositions& positions);

    const AxisValues& off_plan() const { return off_plan_; }

private:
    // Looks that are due by then, and what is not needed any more from then on.
    void tend(std::int64_t time_ns, const StepPositions& positions);
    void look_until(std::int64_t time_ns, const StepPositions& positions);
    // Where the play lets the axis be when the motor is at a position.
    double carried_steps(std::size_t motor, std::int64_t position) const;
    double planned(std::size_t motor, std::int64_t time_ns);
    void measure(std::size_t motor, double off_steps);

    ShapedPlan plan_;
    AxisValues play_steps_{}, at_steps_{};  // of the axes; after the last step of each
    std::deque<std::int64_t> looks_ns_;
    std::int64_t next_tend_ns_ = 0;
    ShiftLog shifts_;
    AxisValues off_plan_{};
};

}  // namespace lyr::run
