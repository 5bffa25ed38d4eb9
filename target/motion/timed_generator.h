// Step times of motors whose motion is more than one path: carriages of a delta, axes with an input
// shaper, an extruder with pressure advance, profiles with a jerk limit. Works in time, where
// StepGenerator works in distance; both say the same of the same motion.
//
// Contract
//  1. At every time each motor is within half a step (and TimeWalk::touch_steps) of its ideal position:
//     the kinematics of the taps' sum of the plan, lifted by the bed, and the play made up for.
//  2. A step comes within 1 us of the exact solution (in practice within 1 ns, the rounding of times).
//  3. Positions are whole counts from the origin for the whole print, the extruder's too: nothing
//     drifts.
//  4. Steps come lead_ns() later than the plan says, since copies of the motion may come before it, and
//     the last tail_ns() after its end at the most. Events are in order of time; a motor is never twice
//     in one event.
//  5. The same moves give the same events. Nothing is allocated as long as no more than
//     MoveWindow::expected moves lie within the reach of the taps.

#pragma once

#include "target/motion/shaping.h"
#include "target/motion/step_generator.h"
#include "target/motion/time_walk.h"

namespace lyr::motion {

class TimedGenerator {
public:
    // All motors are at count 0 when the plan is at the origin.
    TimedGenerator(const Kinematics& kinematics, const Point& origin, const Shaping& shaping);

    // The next move of the plan.
    void start(const PlannedMove& planned);
    // The plan rests until then after the moves so far: the steps that lag behind come out.
    void rest_until(std::int64_t plan_ns);
    // There are no more moves.
    void finish();
    // Writes the next events and returns how many; fewer than asked for: more of the plan is needed, or
    // after finish() there are no more.
    std::size_t next(std::span<StepEvent> events);

    const StepCounts& counts() const { return counts_; }
    std::int64_t lead_ns() const { return lead_ns_; }
    std::int64_t tail_ns() const { return lead_ns_ + behind_ns_; }

private:
    struct Motor {
        MotorFunction function;
        TimeWalk walk;
        Instant begin;  // of the piece
        enum class State : std::uint8_t { walking, waiting, done } state = State::waiting;
        // Steps that are known; those after next_ns_ are from `next` to `end`.
        std::array<std::int64_t, TimeWalk::most_steps> times_ns{};
        std::size_t next = 0, end = 0;
    };

    void find(std::size_t motor);
    void keep(std::size_t motor, std::span<const double> times_s);
    void find_waiting();
    void note_waiting();
    bool begin_piece(std::size_t motor);
    // Whether that step goes upwards.
    bool take(std::size_t motor);

    std::array<Motor, motor_count> motors_;
    std::array<std::int64_t, motor_count> next_ns_;  // of a motor's next step, in the plan's time
    std::int64_t wait_ns_ =
        0;  // the soonest of motors that wait, or never: nothing is known from then on
    MoveWindow window_;
    std::int64_t lead_ns_ = 0, behind_ns_ = 0;
    StepCounts counts_{};
    std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace lyr::motion
