#include "kernel/brep/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/brep/defect.h"
#include "kernel/brep/vertex_merging.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

struct Joint {
    EdgeId edge;
    VertexId end, next_start;
    double gap_mm;
};

std::vector<Joint> open_joints(const Model& model) {
    std::vector<Joint> joints;
    for (const Loop& loop : model.loops) {
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const Coedge& here = model.coedges[loop.first_coedge + c];
            const Coedge& next = model.coedges[loop.first_coedge + (c + 1) % loop.coedge_count];
            const VertexId end = model.end_of(here), start = model.start_of(next);
            if (end == start) continue;
            const double gap_mm = (model[end].point - model[start].point).norm();
            joints.push_back({here.edge, end, start, gap_mm});
        }
    }
    return joints;
}

// With two vertices at one place, an edge around a closed curve may have been taken for one without length.
void go_around(Model& model, double reach_mm) {
    for (const Loop& loop : model.loops) {
        if (loop.coedge_count != 1) continue;
        Edge& edge = model.edges[model.coedges[loop.first_coedge].edge.value];
        const double turn = period(edge.curve);
        if (edge.start != edge.end || turn == 0) continue;
        const Point3 start = evaluate(edge.curve, edge.t_start);
        const Point3 middle = evaluate(edge.curve, (edge.t_start + edge.t_end) / 2);
        if ((middle - start).norm() > reach_mm) continue;
        edge.t_end = edge.t_start + std::copysign(turn, edge.t_end - edge.t_start);
    }
}

}  // namespace

bool close_loops(Model& model, const SewingReach& reach, Diagnostics& diagnostics) {
    VertexMerger merger(model.vertices.size());
    const Joint* widest = nullptr;
    std::size_t accepted = 0, closed = 0;
    const std::vector<Joint> joints = open_joints(model);
    for (const Joint& joint : joints) {
        if (!(joint.gap_mm <= reach.limit_mm)) continue;
        merger.merge(joint.end, joint.next_start);
        ++closed;
        if (joint.gap_mm <= reach.accepted_mm) {
            ++accepted;
            if (widest == nullptr || joint.gap_mm > widest->gap_mm) widest = &joint;
            continue;
        }
        diagnostics.push_back(defect(
            Severity::warning,
            "a gap of " + in_mm(joint.gap_mm) + " to the next edge of the loop has been closed",
            model[joint.edge].source, model[joint.end].point));
    }
    if (widest != nullptr) {
        diagnostics.push_back(defect(Severity::note,
                                     std::to_string(accepted) +
                                         " times edges that follow each other end in two vertices "
                                         "at one place; the widest gap, here, is " +
                                         in_mm(widest->gap_mm),
                                     model[widest->edge].source, model[widest->end].point));
    }
    if (closed == 0) return false;
    merger.apply(model);
    go_around(model, reach.limit_mm);
    return true;
}

}  // namespace lyr
