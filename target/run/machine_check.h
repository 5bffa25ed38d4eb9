// Holds decoded steps against the plan, and the plan against the file, for machines whose motors are not
// single axes or whose motion is shaped. Where the plan's paths are the file's curves and the motors are
// where the plan wants them at every time, the head is on the file's path.
//
// Contract
//  1. off_plan() is TimedCheck's.
//  2. off_file() adds to that how far the plan's paths are from the file's curves, at both ends and between.
//     Of a shaped motion it is the latter alone. Its distance_mm is what such steps can put the head off by,
//     at the worst place of those that were visited.
//  3. Curves of the file that the plan leaves out or adds show as a deviation.

#pragma once

#include "target/run/timed_check.h"

namespace lyr::run {

class MachineCheck {
public:
    MachineCheck(const config::Printer& printer, CurveSource source);

    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step) { timed_.step(step); }
    // Also the error that reading the file ended with.
    Status finish(const StepPositions& positions);

    Deviation off_file() const;
    const AxisValues& off_plan() const { return timed_.off_plan(); }

private:
    void compare_path(const motion::PlannedMove& move);
    void measure_path(const AxisValues& planned_mm, const PathCurve& curve, double share);
    void stretch(const motion::Point& at);

    motion::Kinematics machine_;
    bool shaped_;
    CurveSource source_;
    TimedCheck timed_;
    AxisValues steps_per_mm_{};
    Deviation path_;          // of the plan from the file
    double mm_per_step_ = 0;  // the largest that the head moves while each motor is off by one
    Status status_ = Done{};
};

}  // namespace lyr::run
