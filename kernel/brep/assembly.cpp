// Faces are copied with their loops; edges and vertices are then renumbered to those in use.

#include "kernel/brep/assembly.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace lyr {
namespace {

template <class T>
std::uint32_t count(const std::vector<T>& table) {
    return static_cast<std::uint32_t>(table.size());
}

void copy_face(const Model& from, FaceId id, ShellId shell, Model& to) {
    to.faces.push_back(from[id]);
    Face& face = to.faces.back();
    face.shell = shell;
    face.first_loop = count(to.loops);
    for (std::uint32_t l = 0; l < face.loop_count; ++l) {
        Loop loop = from.loops[from[id].first_loop + l];
        const auto first = from.coedges.begin() + loop.first_coedge;
        loop.first_coedge = count(to.coedges);
        to.coedges.insert(to.coedges.end(), first, first + loop.coedge_count);
        to.loops.push_back(loop);
    }
}

// New indices of what is marked, in order; the rest has none.
template <class Id>
std::vector<Id> numbered(const std::vector<bool>& used) {
    std::vector<Id> ids(used.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i]) ids[i] = Id{next++};
    }
    return ids;
}

void copy_edges(const Model& from, Model& to) {
    std::vector<bool> edge_used(from.edges.size(), false);
    std::vector<bool> vertex_used(from.vertices.size(), false);
    for (const Coedge& coedge : to.coedges) edge_used[coedge.edge.value] = true;
    for (std::size_t e = 0; e < edge_used.size(); ++e) {
        if (!edge_used[e]) continue;
        vertex_used[from.edges[e].start.value] = vertex_used[from.edges[e].end.value] = true;
    }
    const auto edges = numbered<EdgeId>(edge_used);
    const auto vertices = numbered<VertexId>(vertex_used);
    for (Coedge& coedge : to.coedges) coedge.edge = edges[coedge.edge.value];
    for (std::size_t e = 0; e < edge_used.size(); ++e) {
        if (!edge_used[e]) continue;
        Edge edge = from.edges[e];
        edge.start = vertices[edge.start.value];
        edge.end = vertices[edge.end.value];
        to.edges.push_back(std::move(edge));
    }
    for (std::size_t v = 0; v < vertex_used.size(); ++v) {
        if (vertex_used[v]) to.vertices.push_back(from.vertices[v]);
    }
}

template <class Tag>
TypedIndex<Tag> shifted(TypedIndex<Tag> id, std::uint32_t by) {
    return TypedIndex<Tag>(std::size_t{id.value} + by);
}

}  // namespace

ShellPlan plan_of(const Model& model, ShellId id) {
    const Shell& shell = model[id];
    ShellPlan plan{{}, shell.source, shell.is_surface};
    for (std::uint32_t f = 0; f < shell.face_count; ++f) {
        plan.faces.push_back(FaceId{std::size_t{shell.first_face} + f});
    }
    return plan;
}

SolidPlan plan_of(const Model& model, SolidId id) {
    const Solid& solid = model[id];
    SolidPlan plan{solid.name, solid.source, {}};
    for (std::uint32_t s = 0; s < solid.shell_count; ++s) {
        plan.shells.push_back(plan_of(model, ShellId{std::size_t{solid.first_shell} + s}));
    }
    return plan;
}

Model assembled(const Model& model, const std::vector<SolidPlan>& solids) {
    Model result;
    result.uncertainty_mm = model.uncertainty_mm;
    result.face_names = model.face_names;
    for (const SolidPlan& solid : solids) {
        const SolidId solid_id{result.solids.size()};
        result.solids.push_back(
            {solid.name, count(result.shells), count(solid.shells), solid.source});
        for (const ShellPlan& shell : solid.shells) {
            const ShellId shell_id{result.shells.size()};
            result.shells.push_back({count(result.faces), count(shell.faces), solid_id,
                                     shell.source, shell.is_surface});
            for (const FaceId face : shell.faces) copy_face(model, face, shell_id, result);
        }
    }
    copy_edges(model, result);
    return result;
}

void append(Model& model, Model part) {
    const std::uint32_t vertices = count(model.vertices), edges = count(model.edges),
                        coedges = count(model.coedges), loops = count(model.loops),
                        faces = count(model.faces), shells = count(model.shells),
                        solids = count(model.solids);
    for (Vertex& vertex : part.vertices) model.vertices.push_back(std::move(vertex));
    for (Edge& edge : part.edges) {
        edge.start = shifted(edge.start, vertices);
        edge.end = shifted(edge.end, vertices);
        model.edges.push_back(std::move(edge));
    }
    for (Coedge& coedge : part.coedges)
        model.coedges.push_back({shifted(coedge.edge, edges), coedge.reversed});
    for (Loop& loop : part.loops) {
        loop.first_coedge += coedges;
        model.loops.push_back(loop);
    }
    for (Face& face : part.faces) {
        face.first_loop += loops;
        face.shell = shifted(face.shell, shells);
        model.faces.push_back(std::move(face));
    }
    for (Shell& shell : part.shells) {
        shell.first_face += faces;
        shell.solid = shifted(shell.solid, solids);
        model.shells.push_back(shell);
    }
    for (Solid& solid : part.solids) {
        solid.first_shell += shells;
        model.solids.push_back(std::move(solid));
    }
    model.uncertainty_mm = std::max(model.uncertainty_mm, part.uncertainty_mm);
    model.face_names.merge(part.face_names);
}

}  // namespace lyr
