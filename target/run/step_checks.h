// What a simulation holds the decoded steps against: the file's path and the plan. One machine at a time:
//   each motor one axis, nothing shaped: PathCheck follows the file's curves by shape alone, PlanCheck the
//   plan in time;
//   any other: MachineCheck compares the steps with the plan in time, through the kinematics and the
//   shaping, and the plan's paths with the file's curves.
//
// Contract
//  1. off_file() is the largest distance between the positions that the steps make and the file's path, in
//     steps of each motor; of a shaped motion, which is meant to cut corners, the one between the planned
//     path and the file's.
//  2. off_plan() is that between those positions and the (shaped) plan at the same time.

#pragma once

#include <variant>

#include "target/run/machine_check.h"
#include "target/run/plan_check.h"

namespace lyr::run {

class StepChecks {
public:
    StepChecks(const config::Printer& printer, CurveSource source);

    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step);
    Status finish(const StepPositions& positions);

    Deviation off_file() const;
    const AxisValues& off_plan() const;

private:
    struct AxisChecks {
        PathCheck path;
        PlanCheck plan;
    };

    std::variant<AxisChecks, MachineCheck> checks_;
};

}  // namespace lyr::run
