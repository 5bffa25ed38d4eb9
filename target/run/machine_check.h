// Holds decoded steps against the plan, and the plan against the file, for machines whose motors are not
// single axes or whose motion is shaped. Where the plan's paths are the file's curves and the motors are
// where the plan wants them at every time, the head is on the file's path.
//
// Contract
//  1. off_plan() is the largest distance, in a motor's steps, between the planned position and the one
//     decoded, just before and after each of its steps and at looks_per_move times of each move.
//  2. off_file() adds to that how far the plan's paths are from the file's curves, at both ends and between.
//     Of a shaped motion it is the latter alone. Its distance_mm is what such steps can put the head off by,
//     at the worst place of those that were visited.
//     A motor with play carries its axis only where it has turned by the play; what is measured is the axis.
//  3. Steps without a plan for their time, and curves of the file that the plan leaves out or adds, show as a
//     deviation.

#pragma once

#include "target/run/pulse_schedule.h"
#include "target/run/shaped_plan.h"

namespace lyr::run {

class MachineCheck {
public:
    static constexpr int looks_per_move = 8;

    MachineCheck(const config::Printer& printer, CurveSource source);

    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step);
    // Also the error that reading the file ended with.
    Status finish(const StepPositions& positions);

    Deviation off_file() const;
    const AxisValues& off_plan() const { return off_plan_; }

private:
    void compare_path(const motion::PlannedMove& move);
    void measure_path(const AxisValues& planned_mm, const PathCurve& curve, double share);
    void stretch(const motion::Point& at);
    void look_until(std::int64_t time_ns, const StepPositions& positions);
    // Where the play lets the axis be when the motor is at a position.
    double carried_steps(std::size_t motor, std::int64_t position) const;
    double planned(std::size_t motor, std::int64_t time_ns);
    void measure(std::size_t motor, double planned_steps, std::int64_t position);

    motion::Kinematics machine_;
    bool shaped_;
    CurveSource source_;
    ShapedPlan plan_;
    AxisValues steps_per_mm_{};
    AxisValues play_steps_{}, at_steps_{};  // of the axes
    std::deque<std::int64_t> looks_ns_;
    std::deque<Shift> shifts_;
    std::int64_t shift_ns_ = 0;
    AxisValues off_plan_{};
    Deviation path_;          // of the plan from the file
    double mm_per_step_ = 0;  // the largest that the head moves while each motor is off by one
    Status status_ = Done{};
};

}  // namespace lyr::run
