// What arranging and refining have in common: vertices in the sweep's order, edges upwards, coincident ones added up.

#include <algorithm>
#include <numeric>
#include <tuple>

#include "kernel/region/arrangement.h"

namespace lyr::region {
namespace {

void sort_vertices(const std::vector<Point2>& points, Arrangement& arrangement) {
    std::vector<std::uint32_t> order(points.size()), rank(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(points[a].y(), points[a].x()) < std::tuple(points[b].y(), points[b].x());
    });
    std::vector<Point2> sorted;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        rank[order[i]] = i;
        sorted.push_back(points[order[i]]);
    }
    arrangement.vertices = std::move(sorted);
    for (Edge& edge : arrangement.edges) {
        edge.low = rank[edge.low];
        edge.high = rank[edge.high];
        if (edge.high < edge.low) edge = turned_round(edge);
    }
}

void merge_edges(std::vector<Edge>& edges, double snap_mm) {
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.sagitta_mm, a.source) <
               std::tie(b.low, b.high, b.sagitta_mm, b.source);
    });
    std::size_t kept = 0;
    for (std::size_t first = 0; first < edges.size();) {
        Edge sum = edges[first];
        std::size_t last = first + 1;
        for (; last < edges.size(); ++last) {
            const Edge& edge = edges[last];
            if (edge.low != sum.low || edge.high != sum.high ||
                edge.sagitta_mm - edges[first].sagitta_mm > snap_mm) {
                break;
            }
            const Winding change = sum.change + edge.change;
            if (edge.source < sum.source) sum = edge;
            sum.change = change;
        }
        if (!(sum.change == Winding{})) edges[kept++] = sum;
        first = last;
    }
    edges.resize(kept);
}

}  // namespace

Edge turned_round(const Edge& edge) {
    return {edge.high,   edge.low,   -edge.sagitta_mm, -edge.sweep_rad, Winding{} - edge.change,
            edge.source, !edge.along};
}

Curve shape_of(const Edge& edge, const std::vector<Point2>& vertices) {
    return curve_of(vertices[edge.low], {vertices[edge.high], edge.sagitta_mm});
}

void finish(const std::vector<Point2>& points, double snap_mm, Arrangement& arrangement) {
    sort_vertices(points, arrangement);
    merge_edges(arrangement.edges, snap_mm);
}

}  // namespace lyr::region
