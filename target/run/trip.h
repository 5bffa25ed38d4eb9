// A trip away from the path while the head rests on it: to the park place, back, and filament in between.
//
// Contract
//  1. A trip begins and ends at rest, keeps the machine's limits, and its events begin and end with the levels that are
//     given.
//  2. The motors make as many steps there as back: after legs that end where they began, no motor has moved, whatever
//     its steps are and wherever between two of them the head stood.
//  3. Input shaping, pressure advance, play and the bed's heights are left out: nothing is printed on the way.
//  4. head_at() is where the head is when its motors have made so many steps from the printer's start. Its z counts from
//     the bed's height there: it is that of the path and how much higher than at the start the bed is below the head.

#pragma once

#include <span>
#include <vector>

#include "target/config/printer.h"
#include "target/motion/path.h"
#include "target/run/executor.h"

namespace lyr::run {

// Straight on to a point, or, where that is the place itself, of filament alone.
struct Leg {
    motion::Point to;
    double feed_mm = 0;  // of filament; below 0: drawn back
    double speed_mm_s = 0;
};

// Errors (status machine): those of the planner.
Result<std::vector<LineEvent>> plan_trip(const config::Printer& printer, const motion::Point& from,
                                         std::span<const Leg> legs, gpio::LineMask levels);

motion::Point head_at(const config::Printer& printer, const StepPositions& steps);

}  // namespace lyr::run
