// Vertices that are found to be one.

#pragma once

#include <cstddef>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

class VertexMerger {
public:
    explicit VertexMerger(std::size_t vertices);

    void merge(VertexId a, VertexId b);

    // Edges get the vertex of the lowest index of those that are one; the others are no longer used.
    void apply(Model& model);

private:
    std::uint32_t find(std::uint32_t vertex);

    std::vector<std::uint32_t> parent_;
};

}  // namespace lyr
