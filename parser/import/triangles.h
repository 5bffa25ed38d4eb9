// Tessellated geometry of AP242 as solids of plane triangles, which is what the file states: no more is known of the
// shape.
//
// Contract
//  1. TESSELLATED_SOLID, TESSELLATED_SHELL, and alone TRIANGULATED_FACE, TRIANGULATED_SURFACE_SET and their COMPLEX
//     forms (strips and fans). Each is one solid of one shell; triangles share the vertices whose coordinates are
//     the same, and the edges between them. Triangles with two corners in one point are none.
//  2. One that does not close bounds no volume, and one that stands for an exact shape (its link is set) is no
//     other solid: each is listed in `open`.
//  3. Curved triangles (CUBIC_BEZIER_...) are an error, status unsupported.

#pragma once

#include "parser/import/solids.h"

namespace lyr::importer {

bool is_tessellated(std::string_view type);

Result<Part> read_triangles(const File& file, InstanceIndex item, const Units& units,
                            Diagnostics& diagnostics);

}  // namespace lyr::importer
