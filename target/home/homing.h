// Finds where the head is, by endstops and probe.
//
// Method. Each axis goes towards its endstop, fast, until that triggers; goes back; comes again, slowly; and then the
// axis is where the endstop is, plus what it has run on since the step at which it triggered. Overrun therefore does not
// matter. The towers of a delta go at once, each until its own endstop. Motors that carry an axis together (CoreXY) are
// added up, so that every machine but a delta is homed by axes.
//
// Contract
//  1. The result is where the head is, to a microstep of what the endstop's contact gives, wherever it was at first.
//  2. An endstop that is touched at first is left before it is approached, slowly and twice.
//  3. Errors (status machine), after which nothing is known of the head's place: an endstop that does not trigger within
//     the axis's length and margin_mm; that is still triggered after backing off; two approaches that differ by more
//     than tolerance_mm.
//  4. Axes without an endstop, and those that were not asked for, are taken to be at start_mm. Where the probe homes z,
//     x and y are homed too, and before it.
//  5. Nothing goes downwards or sideways before z was lifted; a delta and a z axis that homes upwards first need no lift.
//  6. travel() goes upwards first and downwards last. With backlash, all motors arrive downwards, as a print expects it;
//     the head's coordinates are those of motors that last moved downwards.

#pragma once

#include "target/home/mover.h"
#include "target/motion/kinematics.h"

namespace lyr::home {

using AxisSet = std::bitset<3>;

struct Homed {
    motion::Point head;
    double repeat_mm = 0;  // the largest difference of two approaches
};

// Which axes can be homed.
AxisSet homable(const config::Printer& printer);

Result<Homed> home(Mover& mover, const config::Printer& printer, AxisSet axes);

// `printer` without what belongs to prints only: the head's coordinates are the machine's own.
config::Printer bare_machine(const config::Printer& printer);

Status travel(Mover& mover, const config::Printer& printer, const motion::Point& from,
              const motion::Point& to);

}  // namespace lyr::home
