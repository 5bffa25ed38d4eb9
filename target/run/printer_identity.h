// Tells printers apart by what a print that was cut off must find again as it was: a head that is placed, and moved,
// otherwise would go on beside the part, or into it.
//
// Contract
//  1. What counts, each for itself: the name; the kinematics, with a delta's frame; which lines step and turn the motors
//     of x, y and z, and which way; their steps_per_mm; their range_mm; the height map of the bed, with the place that
//     its heights count from.
//  2. Nothing else does: speeds, heaters, the extruder, endstops and files may be mended in between.
//  3. difference() names what is not the same; empty: they are one printer.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "target/config/printer.h"

namespace lyr::run {

inline constexpr std::array<std::string_view, 6> printer_parts{
    "name", "kinematics", "motors' lines", "steps_per_mm", "range_mm", "height map"};

struct PrinterIdentity {
    std::array<std::uint32_t, printer_parts.size()> parts{};  // a checksum of each
    friend bool operator==(const PrinterIdentity&, const PrinterIdentity&) = default;
};

PrinterIdentity identity_of(const config::Printer& printer);

// "name, steps_per_mm"
std::string difference(const PrinterIdentity& a, const PrinterIdentity& b);

}  // namespace lyr::run
