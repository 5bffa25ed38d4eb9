// The steps of a printer's motors from its plan, by the generator that its machine needs.
//
// Contract
//  1. The steps are those of motion::StepGenerator, or of motion::TimedGenerator where
//     moves::is_timed() says so.

#pragma once

#include <variant>

#include "target/motion/timed_generator.h"
#include "target/moves/machine.h"
#include "target/run/pulse_schedule.h"

namespace lyr::run {

class MotorSteps {
public:
    explicit MotorSteps(const config::Printer& printer);

    void start(const motion::PlannedMove& planned);
    // The plan rests until then: steps that lag behind it come out.
    void rest_until(std::int64_t plan_ns);
    // All of the plan has been started.
    void finish();
    std::size_t next(std::span<motion::StepEvent> events);
    // By how much the last step may come after the plan's end.
    std::int64_t tail_ns() const;

private:
    std::variant<motion::StepGenerator, motion::TimedGenerator> generator_;
};

// One for each motor that moves.
void append_steps(std::span<const motion::StepEvent> events, std::vector<Step>& steps);

}  // namespace lyr::run
