// When each motor steps: a motor steps when its ideal position passes the middle between two
// microsteps, so that it is always at the microstep nearest to the ideal. Times are solved, not
// sampled: the inverse of the motor's function of distance, then the inverse of the speed profile,
// both in closed form.
//
// Contract
//  1. At every time each motor is within half a microstep (and MotorWalk::touch_steps) of its ideal
//     position.
//  2. A step comes within 1 us of the exact solution (in practice within 1 ns, the rounding of
//     times).
//  3. Positions are whole counts from the origin for the whole print: nothing drifts. The
//     extruder's fraction of a step is carried from move to move.
//  4. A position that touches a middle and turns back without passing it by touch_steps makes no
//     step; one that stops there and goes on makes it when it goes on.
//  5. Events come in order of time. Motors that step in the same nanosecond of a move share an
//     event; a motor is never twice in one event.
//  6. The same moves give the same events. Nothing is allocated.

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "target/motion/kinematics.h"
#include "target/motion/motor_walk.h"
#include "target/motion/planner.h"

namespace lyr::motion {

struct StepEvent {
    std::int64_t time_ns = 0;
    std::uint8_t motors = 0;    // bit m: motor m steps
    std::uint8_t positive = 0;  // bit m: and it does so upwards; 0 for motors that do not step
};

using StepCounts = std::array<std::int64_t, motor_count>;

class StepGenerator {
public:
    // All motors are at count 0 at the origin.
    StepGenerator(const LinearKinematics& kinematics, const Point& origin);

    // The next move; all events of the one before must have been taken.
    void start(const PlannedMove& planned);
    // Writes the next events and returns how many; fewer than asked for: the move has no more.
    std::size_t next(std::span<StepEvent> events);

    // After the events taken so far.
    const StepCounts& counts() const { return counts_; }

private:
    struct Pending {
        MotorWalk walk;
        std::size_t phase = 0;  // of the profile, in which the next step lies
    };

    void find(std::size_t motor);
    void take(std::size_t motor, StepEvent& event);

    LinearKinematics kinematics_;
    Point origin_;
    Profile profile_;
    std::int64_t start_ns_ = 0;
    double start_part_ns_ = 0;
    std::array<Pending, motor_count> pending_;
    std::array<std::int64_t, motor_count> next_ns_;  // since start_ns_
    StepCounts counts_{};
    double extruder_part_ = 0;  // of a step, that the extruder's ideal is ahead of its count
    std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace lyr::motion
