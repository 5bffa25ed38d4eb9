// Union-find.

#include "kernel/brep/vertex_merging.h"

#include <algorithm>
#include <numeric>

namespace lyr {

VertexMerger::VertexMerger(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), 0u);
}

std::uint32_t VertexMerger::find(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) {
        parent_[vertex] = parent_[parent_[vertex]];
        vertex = parent_[vertex];
    }
    return vertex;
}

void VertexMerger::merge(VertexId a, VertexId b) {
    const auto [low, high] = std::minmax({find(a.value), find(b.value)});
    parent_[high] = low;
}

void VertexMerger::apply(Model& model) {
    for (Edge& edge : model.edges) {
        edge.start = VertexId{find(edge.start.value)};
        edge.end = VertexId{find(edge.end.value)};
    }
}

}  // namespace lyr
