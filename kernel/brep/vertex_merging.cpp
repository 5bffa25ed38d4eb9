#include "kernel/brep/vertex_merging.h"

namespace lyr {

void VertexMerger::apply(Model& model) {
    for (Edge& edge : model.edges) {
        edge.start = VertexId{one_.of(edge.start.value)};
        edge.end = VertexId{one_.of(edge.end.value)};
    }
}

}  // namespace lyr
