// A print in the Common Layer Interface, version 2.0, in ASCII: what machines that know no filament read.
//
// Contract
//  1. Each layer of the print is a layer at its top's height. What is extruded is a polyline in the order of the file
//     (closed ones turn counter-clockwise if positive: direction 1, clockwise 0; open ones 2), a hatch hatches. They are the
//     middles of the strands.
//  2. Arcs become chords within the tolerance: CLI has none. The file's comment says so, and what else is not in it.
//  3. $$DIMENSION is the box of what is extruded, with the strands' width and from the lowest layer's bottom on. CLI has
//     no thicknesses: a layer reaches down to the one before it, so an empty layer at its bottom is in front of the first.
//  4. Model 1 is the part, model 2 supports and rafts, model 3 skirts, brims and prime towers.

#pragma once

#include "base/diagnostic.h"
#include "format/export/sink.h"
#include "format/reader.h"

namespace lyr::format {

// That of the print; 0.005 mm if it does not state one.
double chord_tolerance_mm(const Metadata& metadata);

// Reads the file to its end, and holds the text until its box is known. Errors: the reader's.
Status write_cli(Reader& reader, const Sink& sink, Diagnostics& diagnostics);

}  // namespace lyr::format
