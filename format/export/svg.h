// A layer of a .lyr file as an SVG picture: what is extruded in its real width, arcs as arcs.
//
// Contract
//  1. The picture's unit is the millimetre of the bed, y upwards; ends of lines and arcs and
//     centres of circles are the file's own, to the last digit of its quantum.
//  2. A line is an L, an arc an A, a full circle a <circle>, in groups of one role and width that
//     follow each other as in the file, walls over the rest; within a group, circles come last.
//  3. The picture depends on the file and the options only; nothing else is needed to show it, and
//     it is well-formed XML whatever the metadata says.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "format/export/sink.h"
#include "format/reader.h"

namespace lyr::format {

struct SvgOptions {
    bool travels = true;  // motions without extrusion, thin and dashed; wipes in red
};

// Calls `take` with all layers in one picture, each a layer of Inkscape's that can be shown and hidden; the first one shows.
// Their groups are as above, without frame and legend. Reads the file to its end. Errors: the reader's.
Status print_svg(Reader& reader, const SvgOptions& options, const Sink& take);

// Of the layer with this number (from 0). Leaves the reader behind the layer. Errors: the reader's.
Result<std::string> layer_svg(Reader& reader, std::uint32_t layer, const SvgOptions& options);

// A role's colour in pictures, as #rrggbb.
std::string_view color_of(Role role);

}  // namespace lyr::format
