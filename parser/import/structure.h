// Which solids a file holds and where each of them stands: representations, product structure, mapped items.
//
// A representation is a set of items in one coordinate system and one set of units. Representations of one product,
// or linked by a plain SHAPE_REPRESENTATION_RELATIONSHIP, share a coordinate system: they form a group. Groups are
// placed in others by product occurrences (NEXT_ASSEMBLY_USAGE_OCCURRENCE with CONTEXT_DEPENDENT_SHAPE_
// REPRESENTATION), by relationships with a transformation, and by mapped items. What is placed nowhere is a root.
//
// Contract
//  1. Each item is listed once for each way from a root to it, with the placement that the way amounts to, in
//     millimetres. Two links between the same groups with the same placement are one (files state occurrences
//     twice, as mapped items too).
//  2. Presentation (draughting, styles) places nothing. Items in no representation stand where they are.
//  3. A structure that contains itself is an error that names the cycle; one that would unfold to more than
//     max_placements solids is an error.

#pragma once

#include <string>
#include <vector>

#include "kernel/geometry/vector.h"
#include "parser/import/entity.h"
#include "parser/import/units.h"

namespace lyr::importer {

// Enough for any assembly that is printed in one go, and an end to ones that double at each level.
inline constexpr std::size_t max_placements = 100'000;

struct Placed {
    InstanceIndex item;     // of a kind other than ItemKind::other and ::mapped
    InstanceIndex context;  // that states its units; may be not valid()
    Eigen::Affine3d placement;
    std::string product;  // name of the product whose shape it is, "" if there is none
};

Result<std::vector<Placed>> placed_items(const File& file, UnitTable& units,
                                         Diagnostics& diagnostics);

}  // namespace lyr::importer
