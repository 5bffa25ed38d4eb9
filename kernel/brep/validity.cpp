// Counts coedges along and against each edge, shell by shell, and walks each loop from vertex to vertex.

#include "kernel/brep/validity.h"

namespace lyr {
namespace {

Diagnostic warning(std::string message, SourceId source, const Point3& point) {
    return {
        Severity::warning,
        ExitStatus::geometry,
        std::move(message),
        {.entity = source, .layer = {}, .x_mm = point.x(), .y_mm = point.y(), .z_mm = point.z()}};
}

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
            found.push_back(warning(
                "the loop is not closed after edge #" + std::to_string(model[here.edge].source),
                loop.source, model[model.end_of(here)].point));
        }
    }
    std::vector<int> excess(model.edges.size(), 0);
    for (const ShellId id : open_shells(model)) {
        count_uses(model, model[id], excess);
        for (std::size_t e = 0; e < excess.size(); ++e) {
            if (excess[e] == 0) continue;
            const Edge& edge = model.edges[e];
            found.push_back(warning("the edge is not shared by two faces that meet there; shell #" +
                                        std::to_string(model[id].source) + " is open",
                                    edge.source, model[edge.start].point));
            excess[e] = 0;
        }
    }
    return found;
}

}  // namespace lyr
