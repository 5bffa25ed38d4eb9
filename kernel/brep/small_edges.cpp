#include "kernel/brep/small_edges.h"

#include <algorithm>

#include "kernel/brep/assembly.h"
#include "kernel/brep/free_edges.h"
#include "kernel/brep/vertex_merging.h"

namespace lyr {
namespace {

// Coedges of dropped edges are taken out; then loops that they alone made up.
void shorten_loops(Model& model, const std::vector<bool>& dropped) {
    std::vector<Coedge> coedges;
    std::vector<Loop> loops;
    for (Face& face : model.faces) {
        const auto first_loop = static_cast<std::uint32_t>(loops.size());
        for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
            Loop loop = model.loops[l];
            const auto first = static_cast<std::uint32_t>(coedges.size());
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Coedge& coedge = model.coedges[loop.first_coedge + c];
                if (!dropped[coedge.edge.value]) coedges.push_back(coedge);
            }
            const auto left = static_cast<std::uint32_t>(coedges.size()) - first;
            if (left == 0 && loop.coedge_count > 0) continue;
            loop.first_coedge = first;
            loop.coedge_count = left;
            loops.push_back(loop);
        }
        face.first_loop = first_loop;
        face.loop_count = static_cast<std::uint32_t>(loops.size()) - first_loop;
    }
    model.coedges = std::move(coedges);
    model.loops = std::move(loops);
}

}  // namespace

std::vector<EdgeId> edges_within(const Model& model, double length_mm) {
    std::vector<bool> used(model.edges.size(), false);
    for (const Coedge& coedge : model.coedges) used[coedge.edge.value] = true;
    std::vector<EdgeId> found;
    for (std::size_t e = 0; e < model.edges.size(); ++e) {
        const Edge& edge = model.edges[e];
        const Point3& start = model[edge.start].point;
        const auto is_near = [&](double share) {
            return (point_on(edge, share) - start).norm() <= length_mm;
        };
        // The end first: it settles it for nearly all edges.
        if (used[e] && (model[edge.end].point - start).norm() <= length_mm && is_near(0.25) &&
            is_near(0.5) && is_near(0.75)) {
            found.push_back(EdgeId{e});
        }
    }
    return found;
}

void drop_edges(Model& model, const std::vector<EdgeId>& edges) {
    if (edges.empty()) return;
    std::vector<bool> dropped(model.edges.size(), false);
    VertexMerger merger(model.vertices.size());
    for (const EdgeId id : edges) {
        dropped[id.value] = true;
        merger.merge(model[id].start, model[id].end);
    }
    std::vector<bool> had_loops;
    for (const Face& face : model.faces) had_loops.push_back(face.loop_count > 0);
    shorten_loops(model, dropped);
    merger.apply(model);
    std::vector<SolidPlan> plans;
    for (std::size_t s = 0; s < model.solids.size(); ++s) {
        SolidPlan plan = plan_of(model, SolidId{s});
        for (ShellPlan& shell : plan.shells) {
            std::erase_if(shell.faces, [&](FaceId face) {
                return had_loops[face.value] && model[face].loop_count == 0;
            });
        }
        plans.push_back(std::move(plan));
    }
    model = assembled(model, plans);
}

}  // namespace lyr
