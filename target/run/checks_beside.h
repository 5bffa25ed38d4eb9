// The checks of a simulation on a thread of their own, while the next steps are being made: they are a third of the work
// and answer at the end alone.
//
// Contract
//  1. The checks see the calls of expect() and step() in their order, as if they were made here: results are the same.
//  2. They are at most most_waiting batches of about steps_in_batch behind: memory does not grow with the print.
//  3. After finish() the checks are at rest. Without it the destructor leaves what waits undone.

#pragma once

#include <thread>
#include <vector>

#include "target/run/handover.h"
#include "target/run/step_checks.h"

namespace lyr::run {

class ChecksBeside {
public:
    static constexpr std::size_t steps_in_batch = 2'048, most_waiting = 4;

    // The checks' source of curves is called on their thread.
    ChecksBeside(const config::Printer& printer, CurveSource source);
    ~ChecksBeside();
    ChecksBeside(const ChecksBeside&) = delete;
    ChecksBeside& operator=(const ChecksBeside&) = delete;

    void expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts);
    void step(const DecodedStep& step) {
        batch_.steps.push_back({step.time_ns, static_cast<std::uint8_t>(step.axis), step.positive});
    }
    Status finish(const StepPositions& positions);

    // After finish().
    const StepChecks& checks() const { return checks_; }

private:
    // Of the calls in their order: a call of expect() and the steps up to the next one is an entry.
    struct Batch {
        struct Entry {
            std::size_t moves = 0, shifts = 0, steps_before = 0;
        };
        std::vector<Entry> entries;
        std::vector<motion::PlannedMove> moves;
        std::vector<Shift> shifts;
        std::vector<Step> steps;
    };

    void hand_over();
    void check(const Batch& batch);
    void check(std::span<const Step> steps);

    StepChecks checks_;
    StepPositions positions_{};  // as the checks have seen them
    Batch batch_;
    Handover<Batch> waiting_{most_waiting};
    std::thread thread_;
};

}  // namespace lyr::run
