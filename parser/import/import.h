// From the instances of a STEP file to a boundary representation: entities, units and assemblies of
// ISO 10303-42, -43 and -44 as AP203, AP214 and AP242 use them.
//
// Contract
//  1. The model keeps the contract of kernel/brep/model.h: lengths in millimetres, angles in radians, whatever the
//     units of the representations that the parts stand in; mixed units within an assembly included.
//  2. Every solid is there once for each place that the assembly structure gives it (product occurrences, mapped
//     items, nested to any depth), with its own copy of the geometry. A file without assembly structure: every
//     solid once.
//  3. Solids are MANIFOLD_SOLID_BREP, BREP_WITH_VOIDS, FACETED_BREP and the closed shells of surface models; where a
//     product has none of these, its closed sets of triangles. Each solid has one Vertex for each VERTEX_POINT and one
//     Edge for each EDGE_CURVE; of polygons and triangles, one Vertex for each point and one Edge for each side.
//  4. What belongs to a solid and is not understood is an error (status unsupported) naming the entity and its #id;
//     what contradicts the standard (missing, cyclic, of the wrong type or size) is one too (status input). No face
//     is ever left out.
//  5. The open shells of a surface model are one solid, marked as surfaces (Shell::is_surface), with one Vertex and Edge
//     for each instance: whether they bound a volume is for heal() to find. What bounds none for certain (triangles)
//     is a warning beside solids, alone an error. A file with none of all these is an error (status input).

#pragma once

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "parser/part21/part21.h"

namespace lyr::importer {

Result<Model> import_model(const part21::File& file, Diagnostics& diagnostics);

}  // namespace lyr::importer
