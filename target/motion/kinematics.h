// From axes to motors: what a path in x, y, z and e is for each motor, in microsteps, as a function
// of the distance along the path. Every kind of machine is one alternative of Kinematics; a kind of
// function that none of them has needed so far is one more alternative of MotorPath.
//
// Contract
//  1. Motor positions are in microsteps from `origin`, where all of them are 0.
//  2. The extruder's motor counts from the begin of each path: what went before is the caller's to
//     add.
//  3. A motor with negative steps_per_mm turns the other way round; with 0 it never moves.
//  4. head_at() undoes that: where the head is when the motors have that many mm; of a delta the lower of the two
//     places, not a number where there is none.
//  5. carriage_mm() is exact to rounding where the arm reaches; elsewhere it is not a number.

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

// Two motors on crossed belts: the first follows x + y, the second x - y. The others are Cartesian.
struct CoreXy {
    std::array<double, axis_count> steps_per_mm{};
};

// Three carriages on upright towers, each with an arm of fixed length to the head. A carriage is
// sqrt(arm^2 - d^2) above the head, d being the head's distance from the tower in x and y.
struct Delta {
    struct Tower {
        double x_mm = 0, y_mm = 0;  // of the place over which the arm would be upright
        double arm_mm = 0;
    };
    static constexpr std::size_t tower_count = 3;
    std::array<double, axis_count> steps_per_mm{};  // of the three carriages and the extruder
    std::array<Tower, tower_count> towers{};
};

// Machines whose motors are sums of axes: along a path they are in closed form.
using LinearKinematics = std::variant<Cartesian, CoreXy>;
using Kinematics = std::variant<Cartesian, CoreXy, Delta>;

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

const std::array<double, axis_count>& steps_per_mm(const Kinematics& kinematics);

// How much of x, y and z is in a motor of the first three.
using AxisShares = std::array<double, 3>;
AxisShares axis_shares(const LinearKinematics& kinematics, std::size_t motor);

// What the motors of x, y and z follow, in mm.
std::array<double, 3> motors_at(const Kinematics& kinematics, const Point& head);
Point head_at(const Kinematics& kinematics, const std::array<double, 3>& motors_mm);

// Height of a carriage when the head is at a point.
double carriage_mm(const Delta::Tower& tower, const Point& head);

MotorPaths motor_paths(const LinearKinematics& kinematics, const Path& path, const Point& origin);

}  // namespace lyr::motion
