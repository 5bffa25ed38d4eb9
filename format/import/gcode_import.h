// G-code of other slicers (and our own) as a print: what Marlin and Klipper do with it, layer by layer.
//
// Contract
//  1. Lines (G0, G1) and arcs (G2, G3 with I and J or R) are the file's motions, to the quantum. An arc that does not
//     extrude becomes travels along chords within `arc_travel_mm`, as the format has straight ones only.
//  2. What a motion extrudes is kept within 0.1 % or the file's own rounding, whichever is more: by the width and height of
//     its comments and a flow, or by a width where it has no comments.
//  3. Layers are those of the file's comments (PrusaSlicer, OrcaSlicer, Cura, Simplify3D), or else begin where something is
//     extruded at another height than before.
//  4. Commands that mean nothing for a print are passed over. Any other that is not known is a warning with its first line
//     and how often it stands; so is filament pushed at a standstill, which no motion of a print does.
//  5. A line that is no G-code is an error (status input) with file and line. No text makes it crash or loop.

#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "format/writer.h"

namespace lyr::format {

inline constexpr double arc_travel_mm = 0.01;

struct GcodeImportOptions {
    double filament_diameter_mm = 0;  // 0: as the file's comments say, or 1.75
    std::string generator{};          // of the print's metadata
};

// `name` is the text's, for messages; the file's is `source_name`, if its comments do not say.
Result<FileTotals> import_gcode(std::string_view text, const std::string& name,
                                const std::string& source_name, const std::string& lyr_path,
                                const GcodeImportOptions& options, Diagnostics& diagnostics);

}  // namespace lyr::format
