// What the motors of a machine follow: its kinematics, input shapers, pressure advance and the bed together.

#pragma once

#include <array>
#include <memory>

#include "target/motion/motor_function.h"

namespace lyr::motion {

// The taps of x, y and z apart; a machine's motors may mix them.
struct Shaping {
    std::array<Taps, axis_e> axes;            // each with weights of one channel; empty: as planned
    Taps extruder;                            // of filament and pressed filament; empty: as planned
    std::array<double, axis_e> play_steps{};  // of the motors
    std::shared_ptr<const BedMesh> bed{};  // by which z is lifted after all that; none: a flat one
};

// Of x, y and z, or the towers. All are at 0 steps when the plan is at the origin.
MotorFunction function_of(const Kinematics& kinematics, std::size_t motor, const Point& origin,
                          const Shaping& shaping);
MotorFunction extruder_of(const Kinematics& kinematics, const Shaping& shaping);

}  // namespace lyr::motion
