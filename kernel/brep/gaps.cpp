// Free edges are joined at their vertices; chords along them give length and area.

#include "kernel/brep/gaps.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "base/disjoint_sets.h"

namespace lyr {
namespace {

void measure(const Model& model, const std::vector<const FreeEdge*>& edges, Gap& gap) {
    constexpr int chords = 16;
    const Point3 origin = model[model[edges.front()->edge].start].point;
    Vector3 doubled_area = Vector3::Zero();
    gap.around_mm = 0;
    for (const FreeEdge* free : edges) {
        const Edge& edge = model[free->edge];
        Point3 from = point_on(edge, free->reversed ? 1 : 0);
        for (int i = 1; i <= chords; ++i) {
            const double share = static_cast<double>(i) / chords;
            const Point3 to = point_on(edge, free->reversed ? 1 - share : share);
            gap.around_mm += (to - from).norm();
            doubled_area += (from - origin).cross(to - origin);
            from = to;
        }
        gap.edges.push_back(free->edge);
    }
    gap.area_mm2 = doubled_area.norm() / 2;
}

}  // namespace

std::vector<Gap> gaps(const Model& model) {
    const std::vector<FreeEdge> free = free_edges(model);
    DisjointSets sets(free.size());
    std::map<std::pair<ShellId, VertexId>, std::uint32_t> known;
    for (std::uint32_t i = 0; i < free.size(); ++i) {
        const Edge& edge = model[free[i].edge];
        for (const VertexId vertex : {edge.start, edge.end}) {
            sets.join(i, known.try_emplace({model[free[i].face].shell, vertex}, i).first->second);
        }
    }
    std::vector<std::vector<const FreeEdge*>> by_set(free.size());
    for (std::uint32_t i = 0; i < free.size(); ++i) by_set[sets.of(i)].push_back(&free[i]);
    std::erase_if(by_set, [](const auto& edges) { return edges.empty(); });
    std::sort(by_set.begin(), by_set.end(),
              [](const auto& a, const auto& b) { return a.front() < b.front(); });
    std::vector<Gap> result;
    for (const auto& edges : by_set) {
        result.push_back({model[edges.front()->face].shell, {}, 0, 0});
        measure(model, edges, result.back());
    }
    return result;
}

std::string description(const Model& model, const Gap& gap) {
    constexpr std::size_t most_named = 8;
    char size[96];
    std::snprintf(size, sizeof size, "a hole of %.3g mm2, %.4g mm around", gap.area_mm2,
                  gap.around_mm);
    std::string text = std::string(size) + ", edges";
    for (std::size_t i = 0; i < gap.edges.size() && i < most_named; ++i) {
        text += (i == 0 ? " #" : ", #") + std::to_string(model[gap.edges[i]].source);
    }
    if (gap.edges.size() > most_named) {
        text += " and " + std::to_string(gap.edges.size() - most_named) + " more";
    }
    return text;
}

}  // namespace lyr
