// Counts coedges along and against each edge, shell by shell, and walks each loop from vertex to vertex.

#include "kernel/brep/validity.h"

#include <string>
#include <utility>

#include "kernel/brep/defect.h"
#include "kernel/brep/gaps.h"

namespace lyr {
namespace {

// Calls visit(loop) for every loop of a shell.
template <class Visit>
void for_each_loop(const Model& model, const Shell& shell, Visit visit) {
    for (std::uint32_t f = 0; f < shell.face_count; ++f) {
        const Face& face = model.faces[shell.first_face + f];
        for (std::uint32_t l = 0; l < face.loop_count; ++l) visit(model.loops[face.first_loop + l]);
    }
}

// The excess of coedges along over coedges against, by edge, of one shell.
void count_uses(const Model& model, const Shell& shell, std::vector<int>& excess) {
    for_each_loop(model, shell, [&](const Loop& loop) {
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const Coedge& coedge = model.coedges[loop.first_coedge + c];
            excess[coedge.edge.value] += coedge.reversed ? -1 : 1;
        }
    });
}

// Edges that more than one coedge uses, but not as often along as against.
void report_contradictions(const Model& model, Diagnostics& found) {
    std::vector<bool> is_free(model.edges.size(), false);
    for (const FreeEdge& free : free_edges(model)) is_free[free.edge.value] = true;
    std::vector<int> excess(model.edges.size(), 0);
    for (const ShellId id : open_shells(model)) {
        count_uses(model, model[id], excess);
        for_each_loop(model, model[id], [&](const Loop& loop) {
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const EdgeId e = model.coedges[loop.first_coedge + c].edge;
                if (std::exchange(excess[e.value], 0) == 0 || is_free[e.value]) continue;
                const Edge& edge = model[e];
                found.push_back(defect(Severity::warning,
                                       "the faces that meet in the edge do not bound shell #" +
                                           std::to_string(model[id].source) + " from one side",
                                       edge.source, model[edge.start].point));
            }
        });
    }
}

}  // namespace

std::vector<ShellId> open_shells(const Model& model) {
    std::vector<ShellId> open;
    std::vector<int> excess(model.edges.size(), 0);
    for (std::size_t s = 0; s < model.shells.size(); ++s) {
        const Shell& shell = model.shells[s];
        count_uses(model, shell, excess);
        bool closed = true;
        for_each_loop(model, shell, [&](const Loop& loop) {
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                int& uses = excess[model.coedges[loop.first_coedge + c].edge.value];
                closed = closed && uses == 0;
                uses = 0;
            }
        });
        if (!closed) open.push_back(ShellId{s});
    }
    return open;
}

Diagnostics validate(const Model& model) {
    Diagnostics found;
    for (const Loop& loop : model.loops) {
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const Coedge& here = model.coedges[loop.first_coedge + c];
            const Coedge& next = model.coedges[loop.first_coedge + (c + 1) % loop.coedge_count];
            if (model.end_of(here) == model.start_of(next)) continue;
            found.push_back(defect(
                Severity::warning,
                "the loop is not closed after edge #" + std::to_string(model[here.edge].source),
                loop.source, model[model.end_of(here)].point));
        }
    }
    for (const Gap& gap : gaps(model)) {
        const Edge& first = model[gap.edges.front()];
        found.push_back(defect(Severity::warning,
                               "shell #" + std::to_string(model[gap.shell].source) +
                                   " is open: " + description(model, gap),
                               first.source, model[first.start].point));
    }
    report_contradictions(model, found);
    return found;
}

}  // namespace lyr
