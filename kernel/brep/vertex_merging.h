// Vertices that are found to be one.

#pragma once

#include <cstddef>

#include "base/disjoint_sets.h"
#include "kernel/brep/model.h"

namespace lyr {

class VertexMerger {
public:
    explicit VertexMerger(std::size_t vertices) : one_(vertices) {}

    void merge(VertexId a, VertexId b) { one_.join(a.value, b.value); }

    // Edges get the vertex of the lowest index of those that are one; the others are no longer used.
    void apply(Model& model);

private:
    DisjointSets one_;
};

}  // namespace lyr
