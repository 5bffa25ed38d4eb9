// A machine by axes that are moved until they touch something.
//
// Contract
//  1. at_mm() follows what the motors have really done, whatever was asked for.
//  2. home() brings axes to their contacts, all at once, and sets each axis to where its contact is; afterwards all are
//     back off them. The result is the largest difference of two approaches; errors are those of homing.h.
//  3. touch() approaches once and gives where each axis was at its first touch; with one target where all were.

#pragma once

#include "target/home/mover.h"

namespace lyr::home {

struct Target {
    std::size_t axis = 0, contact = 0;
    int direction = -1;
    double reach_mm = 0;  // where it must have triggered
    double at_mm = 0;     // where the axis is then
    double fast_mm_s = 0, slow_mm_s = 0;
    double back_off_mm = 0;
    double tolerance_mm = 0;  // between two approaches
};

// Of its range.
inline double middle_mm(const config::Axis& axis) {
    return (axis.min_mm + axis.max_mm) / 2;
}

class ByAxes {
public:
    using Positions = std::array<double, 3>;

    // Of any kinematics; its start_mm is where it is taken to be. Those of a delta mean nothing until it is homed.
    ByAxes(Mover& mover, config::Printer machine)
        : mover_(mover), machine_(std::move(machine)), at_mm_(machine_.start_mm) {}

    const Positions& at_mm() const { return at_mm_; }
    Result<Moved> move(const Positions& way_mm, double speed_mm_s, Contacts watched = {});
    Result<double> home(std::span<const Target> targets);
    Result<Positions> touch(std::span<const Target> targets, double speed_mm_s, double reach_mm);

    // Leaves the contacts, to back_off_mm from the places given, and comes again.
    Result<Positions> touch_slowly(std::span<const Target> targets, const Positions& leave_mm);
    // An error if one of them is touched.
    Status check_open(std::span<const Target> targets);

private:
    // Where the machine is when its motors have made so many steps since it was there.
    Positions after(const Positions& from_mm, const motion::StepCounts& counts) const;

    Mover& mover_;
    config::Printer machine_;
    Positions at_mm_;
};

}  // namespace lyr::home
