// Input shapers and pressure advance as taps. A shaper splits a motion into copies so spaced that the
// vibrations they excite cancel; pressure advance pushes filament ahead of its speed, because what leaves
// the nozzle follows the pressure, and the pressure what was pushed.
//
// Contract
//  1. The weights of a shaper are positive and add up to 1; offsets are centred: a motion at even speed
//     is shifted by nothing (to the nanosecond that offsets are rounded to).
//  2. On a system of one mass with the frequency and damping given, ZV and MZV leave no vibration and EI
//     the share ei_vibration; MZV leaves less than ZV where the frequency is another, EI less than
//     ei_vibration in a band about it.
//  3. Pressure advance adds advance_s times the speed at which filament is laid down, averaged over
//     smooth_s about the time. It is a difference of two copies, and exact as such: the filament fed is the
//     same in the end.

#pragma once

#include "target/motion/timed_generator.h"

namespace lyr::motion {

enum class ShaperKind : std::uint8_t { none, zv, mzv, ei };

struct Shaper {
    ShaperKind kind = ShaperKind::none;
    double frequency_hz = 0;
    double damping = 0;  // a share of the critical one, below 1
};

struct PressureAdvance {
    double advance_s = 0;
    double smooth_s = 0;
};

inline constexpr double ei_vibration = 0.05;

// For the channel of one axis.
Taps taps_of(const Shaper& shaper, std::size_t axis);
// For the extruder.
Taps taps_of(const PressureAdvance& advance);

}  // namespace lyr::motion
