// The representations of a file that hold or place solids, how they are related, and the products that use them.
//
// Contract
//  1. Every representation with its solids, surface models, mapped items and placements is listed, in the order of
//     the file, whatever its subtype.
//  2. Representations of the same product definition are united, as are those that a plain
//     SHAPE_REPRESENTATION_RELATIONSHIP links: they share one coordinate system.

#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "base/disjoint_sets.h"
#include "parser/import/entity.h"

namespace lyr::importer {

using RepresentationId = TypedIndex<struct RepresentationTag>;

struct Representation {
    InstanceIndex instance, context;
    std::vector<InstanceIndex> items;       // solids, surface models and mapped items
    std::vector<InstanceIndex> placements;  // AXIS2_PLACEMENT_3D among the items
    InstanceIndex product;                  // PRODUCT_DEFINITION; not valid(): none
    InstanceIndex usage;    // NEXT_ASSEMBLY_USAGE_OCCURRENCE whose shape it is; likewise
    bool is_shape = false;  // and not a presentation
    bool is_of_aspect =
        false;  // of a feature of the product's shape (a hole, say), or of a part of it
};

// REPRESENTATION_RELATIONSHIP in its forms.
struct Relationship {
    InstanceIndex instance;
    RepresentationId first, second;  // rep_1, rep_2
    InstanceIndex transformation;    // not valid(): none
    // What it places: the NEXT_ASSEMBLY_USAGE_OCCURRENCE of a CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, or another
    // kind of usage; not valid(): nothing, it relates the representations only.
    InstanceIndex usage;
};

// A product definition within another: NEXT_ASSEMBLY_USAGE_OCCURRENCE.
struct Usage {
    InstanceIndex instance, parent, child;
};

class RepresentationTable {
public:
    static Result<RepresentationTable> read(const File& file);

    std::vector<Representation> representations;
    std::vector<Relationship> relationships;
    std::vector<Usage> usages;

    const Representation& operator[](RepresentationId id) const {
        return representations[id.value];
    }
    RepresentationId find(InstanceIndex representation) const;
    // One of the representations of a product definition's shape; not valid(): it has none.
    RepresentationId of_product(InstanceIndex product_definition) const;
    // The representation that stands for all that are united with it: the first of them in the file.
    RepresentationId united(RepresentationId representation) const;

private:
    Status read_representations(const File& file);
    Status read_representation(const File& file, InstanceIndex instance, bool is_shape);
    Status read_definitions(const File& file);
    Status read_relationships(const File& file);
    Status read_usages(const File& file);
    void unite(RepresentationId a, RepresentationId b);
    void unite_related();

    std::unordered_map<std::uint32_t, RepresentationId> by_instance_;
    std::unordered_map<std::uint32_t, RepresentationId> by_product_;
    mutable DisjointSets joined_;
};

// PRODUCT.name of a product definition, "" where the file does not lead there.
std::string product_name(const File& file, InstanceIndex product_definition);

}  // namespace lyr::importer
