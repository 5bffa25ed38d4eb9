// Two rounds, near and far, of: divide edges at each other's vertices, match them one to one, make one of each pair.

#include "kernel/brep/sewing.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/text.h"
#include "kernel/brep/defect.h"
#include "kernel/brep/edge_matching.h"
#include "kernel/brep/edge_splitting.h"
#include "kernel/brep/small_edges.h"
#include "kernel/brep/vertex_merging.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// The second edge of each pair is replaced by the first.
void unite(Model& model, const std::vector<EdgePair>& pairs) {
    struct Substitute {
        EdgeId edge;
        bool reversed;
    };
    std::vector<Substitute> substitute;
    for (std::size_t e = 0; e < model.edges.size(); ++e) substitute.push_back({EdgeId{e}, false});
    VertexMerger merger(model.vertices.size());
    for (const EdgePair& pair : pairs) {
        const Edge &kept = model[pair.a.edge], &replaced = model[pair.b.edge];
        substitute[pair.b.edge.value] = {pair.a.edge, !pair.same_direction};
        merger.merge(kept.start, pair.same_direction ? replaced.start : replaced.end);
        merger.merge(kept.end, pair.same_direction ? replaced.end : replaced.start);
    }
    for (Coedge& coedge : model.coedges) {
        const Substitute& by = substitute[coedge.edge.value];
        coedge = {by.edge, coedge.reversed != by.reversed};
    }
    merger.apply(model);
}

// A pair as it was, for the report: indices change while sewing goes on.
struct Seam {
    SourceId edge, other;
    double gap_mm;
    Point3 point;
};

std::vector<Seam> seams_of(const Model& model, const std::vector<EdgePair>& pairs) {
    std::vector<Seam> seams;
    for (const EdgePair& pair : pairs) {
        const Edge& edge = model[pair.a.edge];
        seams.push_back({edge.source, model[pair.b.edge].source, pair.gap_mm, point_on(edge, 0.5)});
    }
    return seams;
}

void report_sewn(const std::vector<Seam>& seams, Diagnostics& diagnostics) {
    if (seams.empty()) return;
    const auto widest =
        std::max_element(seams.begin(), seams.end(),
                         [](const Seam& a, const Seam& b) { return a.gap_mm < b.gap_mm; });
    diagnostics.push_back(
        defect(Severity::note,
               "faces that meet do not share their edges: " + counted(seams.size(), "edge") +
                   " sewn, the widest gap, here, is " + in_mm(widest->gap_mm),
               widest->edge, widest->point));
}

void report_bridged(const std::vector<Seam>& seams, Diagnostics& diagnostics) {
    for (const Seam& seam : seams) {
        diagnostics.push_back(defect(Severity::warning,
                                     "a gap of " + in_mm(seam.gap_mm) + " to edge #" +
                                         std::to_string(seam.other) +
                                         ", wider than the file's uncertainty, has been closed",
                                     seam.edge, seam.point));
    }
}

// A free edge that is shorter than the reach is a gap's width.
void drop_slivers(Model& model, double reach_mm) {
    std::vector<bool> is_free(model.edges.size(), false);
    for (const FreeEdge& free : free_edges(model)) is_free[free.edge.value] = true;
    std::vector<EdgeId> slivers = edges_within(model, reach_mm);
    std::erase_if(slivers, [&](EdgeId edge) { return !is_free[edge.value]; });
    drop_edges(model, slivers);
}

std::vector<Seam> sew_within(Model& model, double reach_mm) {
    if (free_edges(model).empty()) return {};
    drop_slivers(model, reach_mm);
    split_free_edges(model, free_edges(model), reach_mm);
    FaceParity parity(model);
    const std::vector<EdgePair> pairs = matching_edges(model, free_edges(model), reach_mm, parity);
    std::vector<Seam> seams = seams_of(model, pairs);
    unite(model, pairs);
    return seams;
}

}  // namespace

void sew(Model& model, const SewingReach& reach, Diagnostics& diagnostics) {
    // From near to far, so that the far rounds, in which small edges are lost, have only real gaps to close.
    constexpr double step = 100;
    std::vector<Seam> sewn;
    for (double near_mm = resolution_mm; near_mm <= reach.accepted_mm; near_mm *= step) {
        const double reach_mm = near_mm * step > reach.accepted_mm ? reach.accepted_mm : near_mm;
        const std::vector<Seam> seams = sew_within(model, reach_mm);
        sewn.insert(sewn.end(), seams.begin(), seams.end());
    }
    report_sewn(sewn, diagnostics);
    report_bridged(sew_within(model, reach.limit_mm), diagnostics);
}

}  // namespace lyr
