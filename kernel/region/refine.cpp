// Edges are cut where a sweep found that they meet. Their shape is that which they have, bent to their vertices: what
// crosses because of that is what has to be cut.

#include <algorithm>
#include <tuple>

#include "kernel/region/arrangement.h"
#include "kernel/region/vertex_set.h"

namespace lyr::region {
namespace {

struct Cut {
    std::uint32_t edge;
    double along_mm;
    std::uint32_t vertex;
};

// By edge, and in the order along it. New vertices are added to the set.
std::vector<Cut> cuts_of(const Arrangement& arrangement, std::span<const Contact> contacts,
                         VertexSet& vertices) {
    std::vector<Cut> cuts;
    for (const Contact& contact : contacts) {
        const std::uint32_t vertex = vertices.add(contact.point);
        for (const std::uint32_t e : {contact.edge_a, contact.edge_b}) {
            const Edge& edge = arrangement.edges[e];
            if (vertex == edge.low || vertex == edge.high) continue;
            const Curve curve = shape_of(edge, arrangement.vertices);
            cuts.push_back({e, along_mm(curve, vertices.points()[vertex]), vertex});
        }
    }
    const auto key = [](const Cut& cut) { return std::tie(cut.edge, cut.along_mm, cut.vertex); };
    std::sort(cuts.begin(), cuts.end(),
              [&](const Cut& a, const Cut& b) { return key(a) < key(b); });
    const auto same = [&](const Cut& a, const Cut& b) { return key(a) == key(b); };
    cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
    return cuts;
}

void cut_edge(const Edge& edge, const Curve& curve, std::span<const Cut> cuts,
              const std::vector<Point2>& points, std::vector<Edge>& parts) {
    double at = -curve.half_mm;
    std::uint32_t from = edge.low;
    const auto add = [&](std::uint32_t to, double along) {
        Edge part = edge;
        part.low = from;
        part.high = to;
        part.sweep_rad = curve.curvature_per_mm * (along - at);
        if (edge.sagitta_mm != 0) {
            part.sagitta_mm = arc_with_sweep(points[from], points[to], part.sweep_rad).sagitta_mm;
        }
        parts.push_back(part);
        from = to;
        at = along;
    };
    for (const Cut& cut : cuts) add(cut.vertex, cut.along_mm);
    add(edge.high, curve.half_mm);
}

}  // namespace

Arrangement refined(const Arrangement& arrangement, std::span<const Contact> contacts,
                    double snap_mm) {
    VertexSet vertices(vertex_share * snap_mm);
    for (const Point2& point : arrangement.vertices) vertices.append(point);
    const std::vector<Cut> cuts = cuts_of(arrangement, contacts, vertices);
    Arrangement result{{}, arrangement.sources, {}, arrangement.steps};
    auto first = cuts.begin();
    for (std::uint32_t e = 0; e < arrangement.edges.size(); ++e) {
        const Edge& edge = arrangement.edges[e];
        auto last = first;
        while (last != cuts.end() && last->edge == e) ++last;
        if (first == last) {
            result.edges.push_back(edge);
            continue;
        }
        cut_edge(edge, shape_of(edge, arrangement.vertices), {first, last}, vertices.points(),
                 result.edges);
        result.steps[arrangement.sources[edge.source].contour] +=
            static_cast<std::uint32_t>(last - first);
        first = last;
    }
    finish(vertices.points(), snap_mm, result);
    return result;
}

}  // namespace lyr::region
