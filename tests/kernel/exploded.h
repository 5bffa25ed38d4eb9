// Solids taken apart, as files state them whose faces share nothing: every face with its own edges and vertices.

#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "kernel/brep/assembly.h"
#include "kernel/brep/loop_orientation.h"
#include "kernel/brep/model.h"

namespace lyr::testing {

struct Explosion {
    double jitter_mm = 0;         // by which copies of an edge or a vertex may be apart
    bool turns_faces = false;     // half of them look the other way
    bool turns_loops = false;     // a third of the loops, where that leaves a contradiction
    bool splits_edges = false;    // a third of the edges come in pieces
    bool frees_vertices = false;  // each edge has its own, within a face too
    bool as_surfaces = false;     // every face a surface model of its own, not the shell of a solid
    unsigned seed = 0;
};

class Exploder {
public:
    Exploder(const Model& model, const Explosion& how)
        : from_(model), how_(how), random_(how.seed) {}

    // Of the first shell of a model.
    Model result() {
        to_.uncertainty_mm = from_.uncertainty_mm;
        std::vector<std::size_t> order(from_.shells[0].face_count);
        std::iota(order.begin(), order.end(), std::size_t{from_.shells[0].first_face});
        std::shuffle(order.begin(), order.end(), random_);
        for (const std::size_t f : order) {
            if (to_.shells.empty() || how_.as_surfaces) begin_shell();
            add_face(from_.faces[f]);
            ++to_.shells.back().face_count;
        }
        renumber();
        return std::move(to_);
    }

private:
    bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random_) == 1; }
    Vector3 jitter(double size_mm) {
        std::uniform_real_distribution<double> unit(-1, 1);
        const double x = unit(random_), y = unit(random_), z = unit(random_);
        // No longer than the size whatever the direction.
        return size_mm / std::sqrt(3.0) * Vector3(x, y, z);
    }

    void begin_shell() {
        const SolidId solid{to_.solids.size()};
        to_.solids.push_back(
            {"part", static_cast<std::uint32_t>(to_.shells.size()), 1, 90 + solid.value});
        to_.shells.push_back({static_cast<std::uint32_t>(to_.faces.size()), 0, solid,
                              10 + solid.value, how_.as_surfaces});
    }

    void add_face(const Face& face) {
        Face copy = face;
        copy.first_loop = static_cast<std::uint32_t>(to_.loops.size());
        copy.shell = ShellId{to_.shells.size() - 1};
        const bool is_round = std::holds_alternative<Sphere>(face.surface) ||
                              std::holds_alternative<Torus>(face.surface);
        for (std::uint32_t l = 0; l < face.loop_count; ++l) {
            const Loop& loop = from_.loops[face.first_loop + l];
            to_.loops.push_back({static_cast<std::uint32_t>(to_.coedges.size()), 0, loop.source});
            std::vector<VertexId> known(from_.vertices.size());
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                add_use(from_.coedges[loop.first_coedge + c], known);
            }
            to_.loops.back().coedge_count =
                static_cast<std::uint32_t>(to_.coedges.size()) - to_.loops.back().first_coedge;
            if (how_.turns_loops && !is_round && one_in(3)) reverse_loop(to_, to_.loops.back());
        }
        to_.faces.push_back(copy);
        if (how_.turns_faces && one_in(2)) reverse_face(to_, FaceId{to_.faces.size() - 1});
    }

    VertexId add_vertex(const Point3& point, SourceId source) {
        to_.vertices.push_back({point + jitter(how_.jitter_mm / 4), source});
        return VertexId{to_.vertices.size() - 1};
    }
    VertexId vertex(VertexId id, std::vector<VertexId>& known) {
        if (!known[id.value].valid())
            known[id.value] = add_vertex(from_[id].point, from_[id].source);
        return known[id.value];
    }

    void add_use(const Coedge& use, std::vector<VertexId>& known) {
        Edge whole = from_[use.edge];
        Eigen::Affine3d move = Eigen::Affine3d::Identity();
        move.translate(jitter(how_.jitter_mm / 4));
        whole.curve = transformed(whole.curve, move);
        if (how_.frees_vertices) known.assign(known.size(), VertexId());
        whole.start = vertex(from_[use.edge].start, known);
        whole.end = vertex(from_[use.edge].end, known);
        std::vector<Edge> pieces{whole};
        if (how_.splits_edges && one_in(3)) pieces = split(whole);
        if (use.reversed) std::reverse(pieces.begin(), pieces.end());
        for (Edge& piece : pieces) {
            const bool turned = one_in(2);
            if (turned) {
                std::swap(piece.start, piece.end);
                std::swap(piece.t_start, piece.t_end);
            }
            to_.coedges.push_back({EdgeId{to_.edges.size()}, use.reversed != turned});
            to_.edges.push_back(piece);
        }
    }

    std::vector<Edge> split(const Edge& whole) {
        std::uniform_real_distribution<double> share(0.2, 0.8);
        const double t = whole.t_start + share(random_) * (whole.t_end - whole.t_start);
        Edge first = whole, second = whole;
        first.t_end = second.t_start = t;
        first.end = second.start = add_vertex(evaluate(whole.curve, t), whole.source);
        return {first, second};
    }

    // Edges and vertices in random order.
    void renumber() {
        const auto shuffled = [&](std::size_t count) {
            std::vector<std::size_t> to(count);
            std::iota(to.begin(), to.end(), std::size_t{0});
            std::shuffle(to.begin(), to.end(), random_);
            return to;
        };
        const auto vertex = shuffled(to_.vertices.size()), edge = shuffled(to_.edges.size());
        Model from = to_;
        for (std::size_t v = 0; v < vertex.size(); ++v) to_.vertices[vertex[v]] = from.vertices[v];
        for (std::size_t e = 0; e < edge.size(); ++e) {
            Edge moved = from.edges[e];
            moved.start = VertexId{vertex[moved.start.value]};
            moved.end = VertexId{vertex[moved.end.value]};
            to_.edges[edge[e]] = moved;
        }
        for (Coedge& coedge : to_.coedges) coedge.edge = EdgeId{edge[coedge.edge.value]};
    }

    const Model& from_;
    Explosion how_;
    std::mt19937 random_;
    Model to_;
};

// Both side by side, each with its own of everything.
inline Model joined(Model a, const Model& b) {
    append(a, b);
    return a;
}

inline Model exploded(const Model& model, const Explosion& how) {
    return Exploder(model, how).result();
}

}  // namespace lyr::testing
