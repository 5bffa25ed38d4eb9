// From axes to motors: what a path in x, y, z and e is for each motor, in microsteps, as a function
// of the distance along the path. Every kind of machine is one alternative of Kinematics; a kind of
// function that none of them has needed so far is one more alternative of MotorPath.
//
// Contract
//  1. Motor positions are in microsteps from `origin`, where all of them are 0.
//  2. The extruder's motor counts from the begin of each path: what went before is the caller's to
//     add.
//  3. A motor with negative steps_per_mm turns the other way round; with 0 it never moves.

#pragma once

#include <array>
#include <variant>

#include "base/diagnostic.h"
#include "target/motion/path.h"

namespace lyr::motion {

inline constexpr std::size_t motor_count = 4;
// Of every machine; contract 2.
inline constexpr std::size_t extruder_motor = 3;

// Each axis has its own motor, of the same number.
struct Cartesian {
    std::array<double, axis_count> steps_per_mm{};
};

using Kinematics = std::variant<Cartesian>;

// start + rate * distance
struct Linear {
    double start = 0;
    double rate = 0;  // per mm
};

// start + amplitude * (cos(phase + rate * distance) - cos(phase)), amplitude and rate positive.
struct Harmonic {
    double start = 0;
    double amplitude = 0;
    double phase_rad = 0;  // 0..2 pi
    double rate = 0;       // rad per mm
};

using MotorPath = std::variant<Linear, Harmonic>;
using MotorPaths = std::array<MotorPath, motor_count>;

// Beyond any drive: a step of a nanometre.
inline constexpr double most_steps_per_mm = 1e6;

// Steps per mm are numbers up to most_steps_per_mm; otherwise which are not (status machine).
Status check(const Kinematics& kinematics);

MotorPaths motor_paths(const Kinematics& kinematics, const Path& path, const Point& origin);

}  // namespace lyr::motion
