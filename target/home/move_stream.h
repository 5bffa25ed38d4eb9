// From moves to line events, as run::EventStream is from a file to them: a few at a time, as the machine moves.
//
// Contract
//  1. What the planner refuses is found by create(), before there are events.
//  2. The first event switches the motor drivers on, as in a print; the motors stay on after the last.
//  3. Events are in order of time. What is held does not grow with the length of the moves, only with their number.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "target/motion/planner.h"
#include "target/run/motor_steps.h"

namespace lyr::home {

class MoveStream {
public:
    // `machine` says what the moves mean for the motors, its start_mm where they begin.
    static Result<MoveStream> create(const config::Printer& machine,
                                     std::span<const motion::Move> moves);

    // Appends the next events; false: these were the last.
    bool next(std::vector<run::LineEvent>& events);

private:
    MoveStream(const config::Printer& machine, motion::Planner planner);

    motion::Planner planner_;
    run::MotorSteps generator_;
    run::PulseSchedule schedule_;
    std::array<motion::StepEvent, 1024> steps_;
    std::vector<run::Step> single_;
    bool begun_ = false, planned_all_ = false;
};

}  // namespace lyr::home
