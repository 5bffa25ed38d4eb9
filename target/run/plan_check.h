// Compares where the pulses put each axis with where the plan wants it at the same moment. The plan is
// evaluated forwards, from time over distance to position, where the step generator solves backwards.
//
// Contract
//  1. The deviation of an axis is the largest distance, in its steps, between the planned and the
//     decoded position: just before and just after each of its steps, at every end of a move, and at
//     every turning point of an arc. Between those both are monotone, so there is none larger.
//  2. Steps without a plan for their time, or a plan without its steps, show as a deviation.

#pragma once

#include <deque>
#include <span>

#include "target/motion/planner.h"
#include "target/run/path_check.h"
#include "target/run/pulse_schedule.h"

namespace lyr::run {

class PlanCheck {
public:
    PlanCheck(const AxisValues& steps_per_mm, const AxisValues& origin_mm)
        : steps_per_mm_(steps_per_mm), origin_mm_(origin_mm) {}

    // What is to come, in order: moves by the planner's time, and by how much events are later.
    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step);
    // The rest of the plan, against the last position.
    void finish(const StepPositions& positions);

    const AxisValues& deviation_steps() const { return deviation_steps_; }

private:
    // A move with the times at which it must be looked at beside its steps.
    struct Piece {
        motion::PlannedMove move;
        double e_start_mm = 0;
        std::array<double, 6> looks_s{};  // since its begin; an arc turns at most five times
        std::size_t look_count = 0, looked = 0;
    };

    void append(const motion::PlannedMove& move);
    void look_until(std::int64_t time_ns, const StepPositions& positions);
    static double since_start_s(const Piece& piece, std::int64_t time_ns);
    static double planned_mm(const Piece& piece, std::size_t axis, double time_s);
    void measure(std::size_t axis, double planned_mm, std::int64_t position);

    AxisValues steps_per_mm_, origin_mm_;
    std::deque<Piece> pieces_;
    ShiftLog shifts_;
    double e_end_mm_ = 0;  // where the last piece leaves the extruder
    double e_error_mm_ =
        0;  // of that sum; hundreds of thousands of roundings would be parts of a step
    AxisValues deviation_steps_{};
};

}  // namespace lyr::run
