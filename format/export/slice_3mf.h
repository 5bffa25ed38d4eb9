// A print as a 3MF package with the slice extension (version 1.0.2): outlines of layers as polygons.
//
// Contract
//  1. Each layer is a slice that ends at the layer's top. Its polygons are the outlines of the part: the outermost walls'
//     middles, moved outwards by half of their width, arcs as chords within the tolerance. Outer ones turn
//     counter-clockwise, holes clockwise. A layer without closed walls is an empty slice.
//  2. The mesh that 3MF asks for is the box of the slices, of low resolution, as the extension allows.
//  3. Slices rise; where the print begins anew from below (parts one after the other), it is refused (status unsupported).
//  4. What is not in it (fill, supports, open walls, all of extrusion) is told in the metadata and to the caller. If no wall is
//     closed, nothing is left, and that is an error (status unsupported).

#pragma once

#include "base/diagnostic.h"
#include "format/export/sink.h"
#include "format/reader.h"

namespace lyr::format {

// Reads the file to its end. Errors: the reader's; see above.
Status write_slice_3mf(Reader& reader, const Sink& sink, Diagnostics& diagnostics);

}  // namespace lyr::format
