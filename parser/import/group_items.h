// Which of the solids that representations list belong to which group of representations (structure.h).
//
// Contract
//  1. A solid belongs to the groups of products that list it; to others only if no product does. Within a group it is
//     there once. Mapped items are no solids of a group.
//  2. A solid that is the shape of a feature (the volume of a hole) is no part of a product that has a shape of its
//     own: left out, with a note.
//  3. Triangles beside an exact shape of the same product, or of a file without products, are that shape once more:
//     left out, with a warning.

#pragma once

#include <utility>
#include <vector>

#include "parser/import/representations.h"

namespace lyr::importer {

struct GroupItems {
    InstanceIndex product;  // PRODUCT_DEFINITION, if there is one
    std::vector<std::pair<InstanceIndex, RepresentationId>> items;  // and where each is listed
};

// By the representation that stands for the group; empty for all others.
std::vector<GroupItems> group_items(const File& file, const RepresentationTable& table,
                                    Diagnostics& diagnostics);

}  // namespace lyr::importer
