// Moves a machine that is not printing: by the planner, the step generator and the executor of a print, and watching
// contacts meanwhile.
//
// Contract
//  1. run() makes the moves from rest to rest. A watched contact that closes brings the machine to rest on its path;
//     the result says which closed, and where the motors were when each was first touched; those that closed as it came
//     to rest are waited for until they have settled.
//  2. Counts of a result are in microsteps since the begin of that run.
//  3. Who asks for a stop (SIGINT, an emergency line, a client of the print) brings the machine to rest, twice at
//     once, and ends with status stopped; asked before, nothing moves. After a run the motors are on, and all lines
//     but enable inactive, as the executor of a print expects them.
//  4. On a board the lines are written by a thread of high priority, fed by another as in a print (run/event_flow.h), and
//     this one watches; what throws here ends them first. With virtual time all is done by this one, step by step.
//  5. What the planner refuses is refused before anything moves. Edges are made while the machine moves, in bounded
//     memory; those after the contact that stops it are never made, but for what the ring holds.

#pragma once

#include <span>

#include "target/home/contacts.h"
#include "target/home/move_stream.h"
#include "target/home/step_tally.h"
#include "target/motion/limits.h"
#include "target/run/stop_signals.h"

namespace lyr::home {

struct Moved {
    motion::StepCounts counts{};  // at rest
    std::array<std::optional<motion::StepCounts>, config::contact_count> at_contact;
    Contacts contacts() const {
        Contacts closed;
        for (std::size_t i = 0; i < at_contact.size(); ++i) closed[i] = at_contact[i].has_value();
        return closed;
    }
};

class Mover {
public:
    // `stop` is empty with virtual time.
    Mover(const config::Printer& printer, gpio::GpioChip& chip, gpio::Clock& clock,
          gpio::InputLines* inputs, run::StopSource stop);

    // `machine` says what the moves mean for the motors, its start_mm where they begin.
    Result<Moved> run(const config::Printer& machine, std::span<const motion::Move> moves,
                      Contacts watched = {});
    Result<Contacts> touched();
    std::int64_t now_ns() const { return clock_.now_ns(); }
    // All in all.
    const motion::StepCounts& counts() const { return tally_.counts(); }

private:
    unsigned asked();
    Result<bool> execute(run::Executor& executor, MoveStream& stream);
    // A watched contact may still settle, and not for ever.
    bool may_settle(std::int64_t since_ns) const;
    Result<bool> execute_beside(run::Executor& executor, MoveStream& stream,
                                run::StopRequests& stop);
    Result<Moved> outcome(const motion::StepCounts& before) const;

    gpio::GpioChip& chip_;
    gpio::Clock& clock_;
    StepTally tally_;
    std::optional<ContactWatch> watch_;
    run::StopSource stop_;
    bool asked_to_stop_ = false;
    std::optional<unsigned> cpu_;
};

}  // namespace lyr::home
