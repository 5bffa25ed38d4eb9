// A print as G-code for Marlin or Klipper: arcs as G2 and G3, comments on layers and roles as PrusaSlicer has them, so
// that viewers and print servers know them.
//
// Contract
//  1. Every motion is one command, in the order of the file: a line G1, an arc or circle G2 or G3 with I and J, a travel
//     G0; hatches are expanded. Exceptions: an arc of more than `largest_arc_mm` or less than `smallest_arc_mm` radius
//     becomes chords within a digit of the coordinates, as firmwares count in single precision; a circle is two halves for
//     Klipper, which takes some whole circles for none; what rounds to no way leaves out its coordinates.
//  2. Positions are absolute and are the file's, to its quantum, but at most to 0.0001 mm. I and J have one digit more, so
//     that both ends of an arc are as far from its centre within 0.0002 mm.
//  3. What is extruded is length times cross-section over that of the filament, in 0.00001 mm. What rounding leaves goes
//     into the next motion: however long the print, its sum is off by less than one such digit.
//  4. What G-code cannot say is a comment in the file and a note to the caller.
//  5. The text depends on the file and the options only.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "format/export/sink.h"
#include "format/reader.h"

namespace lyr::format {

enum class GcodeFlavor : std::uint8_t { marlin, klipper };

// Of radii. Firmwares reckon with 7 digits: up to here an arc's length comes out within 0.001 mm (docs/exports.md), and of
// smaller ones the centre is rounded away.
inline constexpr double largest_arc_mm = 1000, smallest_arc_mm = 0.01;

struct GcodeOptions {
    GcodeFlavor flavor = GcodeFlavor::marlin;
    bool relative_extrusion = true;
    // Lines before and after the print, with placeholders in braces (gcode_macro.h); empty: those of docs/exports.md.
    std::vector<std::string> start{}, end{};
    double nozzle_diameter_mm = 0;  // for print servers; 0: not stated
};

// Reads the file to its end. Errors: the reader's; a placeholder that is not known (usage). Notes and warnings go to
// `diagnostics`.
Status write_gcode(Reader& reader, const GcodeOptions& options, const Sink& sink,
                   Diagnostics& diagnostics);

}  // namespace lyr::format
