// Layers of a print as a drawing for CAD programs (DXF of AutoCAD R12, in ASCII): lines, arcs and circles as such.
//
// Contract
//  1. The unit is the millimetre. Everything lies at z = 0, on one drawing layer for each role ("OUTER_WALL") and one
//     for ways without extrusion ("TRAVEL"). Of several print layers each has drawing layers of its own ("36_OUTER_WALL").
//  2. Ends of lines and centres of circles are the file's; an arc is its centre, radius and angles with so many digits
//     that its ends are the file's within a thousandth of a quantum for radii up to 1 m.
//  3. Widths, speeds, amounts and heights are not in it; comments say what it is of.

#pragma once

#include <cstdint>
#include <optional>

#include "base/diagnostic.h"
#include "format/export/sink.h"
#include "format/reader.h"

namespace lyr::format {

struct DxfOptions {
    std::optional<std::uint32_t> layer{};  // from 0; none: all
    bool travels = true;                   // wipes included
};

// Errors: the reader's.
Status write_dxf(Reader& reader, const DxfOptions& options, const Sink& sink);

}  // namespace lyr::format
