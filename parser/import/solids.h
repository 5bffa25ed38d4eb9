// One item of a representation (a solid, or a surface model) as a model of its own, in its own coordinates.
//
// Contract
//  1. Vertices, edges and faces are shared as the file shares them; each solid has its own.
//  2. Void shells come after the outer one. Every closed shell looks away from the material, voids into the void,
//     whichever way the file states it; where it states it the other way, a note says so.
//  3. Surface models give one solid for each closed shell, and one for all their open shells together, which are
//     marked as surfaces: heal() finds what they bound. Sets of triangles give one solid each; those that do not
//     close are listed in `open`, as errors, and their geometry is not read.

#pragma once

#include <unordered_set>

#include "kernel/brep/model.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

struct Part {
    Model model;
    Diagnostics open;
};

// What an item of a representation is to this program.
enum class ItemKind {
    other,          // bounds no volume: curves, points, placements, surfaces
    solid,          // MANIFOLD_SOLID_BREP, BREP_WITH_VOIDS, FACETED_BREP
    surface_model,  // SHELL_BASED_SURFACE_MODEL, FACE_BASED_SURFACE_MODEL
    tessellated,    // triangles (triangles.h): often beside the exact solid that they approximate
    mapped,         // MAPPED_ITEM
    unsupported,    // a solid of another kind
};
ItemKind kind_of(const File& file, InstanceIndex item);

// Closed shells that solids are made of, so that a surface model on the same shell is not taken for another solid.
using ShellSet = std::unordered_set<std::uint32_t>;
ShellSet shells_of_solids(const File& file);

Result<Part> read_item(const File& file, InstanceIndex item, const Units& units,
                       const ShellSet& taken, part21::Trail& trail, Diagnostics& diagnostics);

}  // namespace lyr::importer
