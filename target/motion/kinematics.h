// How far each motor has turned when the nozzle is at a position.
//
// Contract
//  1. motor_coordinate is in microsteps, counted from the origin of coordinates; steps_per_mm may be negative
//     for a motor that turns the other way.
//  2. position_of(motor_coordinate of each motor) is the position.
//
// A kinematics is one alternative of the variant and one overload of each function below. Those whose motors
// are linear in the position (Cartesian; CoreXY) share the step solver of motor_track.h through motor_form.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "target/motion/path.h"

namespace lyr::motion {

inline constexpr std::size_t kMotors = 4;  // three for the position, one for the extruder

// Motor m drives axis m: 0 x, 1 y, 2 z, 3 e. Microsteps by millimetre, none zero.
struct Cartesian {
    std::array<double, kMotors> steps_per_mm{80, 80, 400, 400};
};

using Kinematics = std::variant<Cartesian>;

// A motor's coordinate as a linear form of the position, in microsteps by millimetre.
struct MotorForm {
    double x = 0, y = 0, z = 0, e = 0;
    bool operator==(const MotorForm&) const = default;
};

MotorForm motor_form(const Kinematics& kinematics, std::size_t motor);
double motor_coordinate(const MotorForm& form, const Position& position);

using MotorCounts = std::array<std::int64_t, kMotors>;
Position position_of(const Kinematics& kinematics, const MotorCounts& counts);

}  // namespace lyr::motion
