// Vertices near an edge are found through boxes around an edge's stretches; then the curve decides.

#include "kernel/brep/edge_splitting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/brep/point_index.h"

namespace lyr {
namespace {

// Free edges by vertex: of[start[v] .. start[v + 1]).
struct ByVertex {
    std::vector<std::uint32_t> start, of;

    ByVertex(const Model& model, const std::vector<FreeEdge>& free)
        : start(model.vertices.size() + 1, 0) {
        const auto for_each_end = [&](auto visit) {
            for (std::size_t i = 0; i < free.size(); ++i) {
                const Edge& edge = model[free[i].edge];
                visit(edge.start.value, static_cast<std::uint32_t>(i));
                if (edge.start != edge.end) visit(edge.end.value, static_cast<std::uint32_t>(i));
            }
        };
        for_each_end([&](std::uint32_t v, std::uint32_t) { ++start[v + 1]; });
        for (std::size_t v = 0; v + 1 < start.size(); ++v) start[v + 1] += start[v];
        of.resize(start.back());
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
        for_each_end([&](std::uint32_t v, std::uint32_t i) { of[next[v]++] = i; });
    }
};

struct Split {
    double t;
    VertexId vertex;
};

class Splitter {
public:
    Splitter(const Model& model, const std::vector<FreeEdge>& free, double reach_mm)
        : model_(model), free_(free), reach_mm_(reach_mm), by_vertex_(model, free), index_({}) {
        std::vector<Point3> points;
        for (std::size_t v = 0; v < model.vertices.size(); ++v) {
            if (by_vertex_.start[v] == by_vertex_.start[v + 1]) continue;
            vertices_.push_back(VertexId{v});
            points.push_back(model.vertices[v].point);
        }
        index_ = PointIndex(std::move(points));
    }

    // From the edge's start on, no two at the same place.
    std::vector<Split> splits_of(const FreeEdge& free) const {
        const Edge& edge = model_[free.edge];
        std::vector<Split> splits;
        for (const VertexId vertex : vertices_near(edge)) {
            const Point3& point = model_[vertex].point;
            if (is_near(point, model_[edge.start].point) || is_near(point, model_[edge.end].point))
                continue;
            const double t = nearest_parameter(edge, point);
            if (!is_near(evaluate(edge.curve, t), point)) continue;
            if (is_covered(free, vertex, t)) splits.push_back({t, vertex});
        }
        const bool rises = edge.t_start < edge.t_end;
        std::sort(splits.begin(), splits.end(), [&](const Split& a, const Split& b) {
            return a.t != b.t ? (a.t < b.t) == rises : a.vertex < b.vertex;
        });
        const auto same = [&](const Split& a, const Split& b) {
            return is_near(model_[a.vertex].point, model_[b.vertex].point);
        };
        splits.erase(std::unique(splits.begin(), splits.end(), same), splits.end());
        return splits;
    }

private:
    bool is_near(const Point3& a, const Point3& b) const { return (a - b).norm() <= reach_mm_; }

    std::vector<VertexId> vertices_near(const Edge& edge) const {
        const bool straight = std::holds_alternative<Line>(edge.curve);
        const auto* spline = std::get_if<BSplineCurve>(&edge.curve);
        const int stretches = spline ? 4 * static_cast<int>(spline->control_points.size()) : 8;
        std::vector<VertexId> found;
        Point3 from = point_on(edge, 0);
        for (int i = 1; i <= stretches; ++i) {
            const Point3 to = point_on(edge, static_cast<double>(i) / stretches);
            Eigen::AlignedBox3d box(from.cwiseMin(to), from.cwiseMax(to));
            // An arc of an eighth of a turn rises a tenth of its chord over it; nothing that is modelled bends more.
            const double bulge = straight ? 0 : 0.25 * (to - from).norm();
            box.extend(Point3(box.min() - Vector3::Constant(reach_mm_ + bulge)));
            box.extend(Point3(box.max() + Vector3::Constant(reach_mm_ + bulge)));
            index_.within(box, [&](std::uint32_t v) { found.push_back(vertices_[v]); });
            from = to;
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    // Whether other free edges that end at the vertex's place run along this one to both sides. Where they go to one
    // side only, it is the other edge's end that is meant, and a gap.
    bool is_covered(const FreeEdge& free, VertexId vertex, double t) const {
        bool before = false, behind = false;
        index_.within(box_around(model_[vertex].point, reach_mm_), [&](std::uint32_t near) {
            const VertexId there = vertices_[near];
            const std::uint32_t last = by_vertex_.start[there.value + 1];
            for (std::uint32_t i = by_vertex_.start[there.value]; i < last; ++i) {
                const FreeEdge& other = free_[by_vertex_.of[i]];
                if (other.edge == free.edge || !may_meet(model_, free, other)) continue;
                look_along(model_[free.edge], t, model_[other.edge], there, before, behind);
            }
        });
        return before && behind;
    }

    void look_along(const Edge& edge, double t, const Edge& other, VertexId from, bool& before,
                    bool& behind) const {
        // No farther than this edge goes on.
        const Point3& origin = model_[from].point;
        const double left_mm = std::min((model_[edge.start].point - origin).norm(),
                                        (model_[edge.end].point - origin).norm());
        const double share = std::min(1.0, left_mm / rough_length_mm(other)) / 2;
        const double turn = period(edge.curve);
        for (const bool at_start : {true, false}) {
            if ((at_start ? other.start : other.end) != from) continue;
            const Point3 point = point_on(other, at_start ? share : 1 - share);
            const double there = nearest_parameter(edge, point);
            if (!is_near(evaluate(edge.curve, there), point)) continue;
            const double by = turn > 0 ? std::remainder(there - t, turn) : there - t;
            (by < 0 ? before : behind) = true;
        }
    }

    const Model& model_;
    const std::vector<FreeEdge>& free_;
    double reach_mm_;
    ByVertex by_vertex_;
    std::vector<VertexId> vertices_;
    PointIndex index_;
};

// Coedges of divided edges become chains; pieces[e] are an edge's pieces from start to end.
void replace_coedges(Model& model, const std::vector<std::vector<EdgeId>>& pieces) {
    std::vector<Coedge> coedges;
    for (Loop& loop : model.loops) {
        const auto first = static_cast<std::uint32_t>(coedges.size());
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const Coedge coedge = model.coedges[loop.first_coedge + c];
            if (coedge.edge.value >= pieces.size() || pieces[coedge.edge.value].empty()) {
                coedges.push_back(coedge);
                continue;
            }
            const auto& chain = pieces[coedge.edge.value];
            for (std::size_t i = 0; i < chain.size(); ++i) {
                const std::size_t at = coedge.reversed ? chain.size() - 1 - i : i;
                coedges.push_back({chain[at], coedge.reversed});
            }
        }
        loop.first_coedge = first;
        loop.coedge_count = static_cast<std::uint32_t>(coedges.size()) - first;
    }
    model.coedges = std::move(coedges);
}

}  // namespace

bool may_meet(const Model& model, const FreeEdge& a, const FreeEdge& b) {
    const Shell& one = model[model[a.face].shell];
    const Shell& other = model[model[b.face].shell];
    return one.solid == other.solid || (one.is_surface && other.is_surface);
}

void split_free_edges(Model& model, const std::vector<FreeEdge>& free, double reach_mm) {
    std::vector<std::vector<EdgeId>> pieces(model.edges.size());
    std::vector<std::pair<EdgeId, std::vector<Split>>> all;
    const Splitter splitter(model, free, reach_mm);
    for (const FreeEdge& edge : free) {
        if (auto splits = splitter.splits_of(edge); !splits.empty()) {
            all.emplace_back(edge.edge, std::move(splits));
        }
    }
    for (const auto& [id, splits] : all) {
        // The edge itself becomes the first piece.
        pieces[id.value].push_back(id);
        for (std::size_t i = 0; i < splits.size(); ++i) {
            Edge piece = model[id];
            piece.t_start = splits[i].t;
            piece.start = splits[i].vertex;
            if (i + 1 < splits.size()) {
                piece.t_end = splits[i + 1].t;
                piece.end = splits[i + 1].vertex;
            }
            pieces[id.value].push_back(EdgeId{model.edges.size()});
            model.edges.push_back(std::move(piece));
        }
        model.edges[id.value].t_end = splits.front().t;
        model.edges[id.value].end = splits.front().vertex;
    }
    if (!all.empty()) replace_coedges(model, pieces);
}

}  // namespace lyr
