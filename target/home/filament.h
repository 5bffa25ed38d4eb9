// Pushes filament by hand, or draws it out, in place of a print: to load it, and to measure steps_per_mm of axis e.
//
// Contract
//  1. The tool is heated, the filament moved once it is warm, at careful_mm_s at the most, and the heater goes off.
//     Nothing else moves, and nothing is homed.
//  2. Refused (status machine) before anything is held: a tool that is there and gets no temperature, or one below its
//     min_extrude_c or within headroom_c of the end of its range; a temperature for a tool that is not there; more than
//     most_fed_mm; what the planner refuses. All of it is planned before there is heat.
//  3. All guards watch throughout. One that fires, SIGINT, SIGTERM, SIGHUP and the emergency line bring the filament to
//     rest. However it ends, all heaters and motors are off.
//  4. What the kernel refuses of real time is a warning.

#pragma once

#include <optional>

#include "target/home/job.h"

namespace lyr::home {

// 5 mm^3/s of the usual filament: any hot end melts that.
inline constexpr double careful_mm_s = 2;

// The longest tube to a hot end. Its edges are held in memory, some 15 MB at 415 steps/mm.
inline constexpr double most_fed_mm = 1'000;

struct Fed {
    std::int64_t steps = 0;
    double speed_mm_s = 0;
    Diagnostics warnings{};
};

// `feed_mm` below 0: drawn out.
Result<Fed> feed(const Job& job, double feed_mm, std::optional<double> tool_c);

}  // namespace lyr::home
