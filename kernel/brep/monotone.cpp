// Heights of vertices and of the turning points inside edges are collected, sorted and merged into levels;
// then each edge becomes the pieces between turning points whose levels differ.

#include "kernel/brep/monotone.h"

#include <algorithm>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// Levels of a set of heights: each height belongs to the level that starts at most resolution_mm below it.
class Levels {
public:
    explicit Levels(std::vector<double> heights_mm) {
        std::sort(heights_mm.begin(), heights_mm.end());
        for (const double z : heights_mm) {
            if (starts_.empty() || z - starts_.back() > resolution_mm) starts_.push_back(z);
        }
    }

    double of(double z) const {
        return *std::prev(std::upper_bound(starts_.begin(), starts_.end(), z));
    }

private:
    std::vector<double> starts_;
};

// Where an edge turns: the parameters and heights of its ends and of the extrema between.
struct Turns {
    std::vector<double> t, z_mm;
};

Turns turns_of(const Edge& edge, const Model& model) {
    Turns turns;
    turns.t.push_back(edge.t_start);
    turns.z_mm.push_back(model[edge.start].point.z());
    for (const double t : height_extrema(edge.curve, edge.t_start, edge.t_end)) {
        turns.t.push_back(t);
        turns.z_mm.push_back(evaluate(edge.curve, t).z());
    }
    turns.t.push_back(edge.t_end);
    turns.z_mm.push_back(model[edge.end].point.z());
    return turns;
}

}  // namespace

MonotoneEdges monotone_pieces(const Model& model) {
    std::vector<Turns> turns;
    turns.reserve(model.edges.size());
    std::vector<double> heights_mm;
    for (const Vertex& vertex : model.vertices) heights_mm.push_back(vertex.point.z());
    for (const Edge& edge : model.edges) {
        turns.push_back(turns_of(edge, model));
        heights_mm.insert(heights_mm.end(), turns.back().z_mm.begin(), turns.back().z_mm.end());
    }
    const Levels levels(std::move(heights_mm));

    MonotoneEdges result;
    for (const Vertex& vertex : model.vertices) {
        result.vertex_level_mm.push_back(levels.of(vertex.point.z()));
    }
    for (std::size_t e = 0; e < turns.size(); ++e) {
        const Turns& turn = turns[e];
        for (std::size_t i = 0; i + 1 < turn.t.size(); ++i) {
            const double from = levels.of(turn.z_mm[i]), to = levels.of(turn.z_mm[i + 1]);
            if (from == to) continue;
            const bool rising = from < to;
            const double low = turn.t[i + (rising ? 0 : 1)], high = turn.t[i + (rising ? 1 : 0)];
            result.pieces.push_back({EdgeId{e}, low, high, std::min(from, to), std::max(from, to),
                                     rising, evaluate(model.edges[e].curve, (low + high) / 2)});
        }
    }
    return result;
}

}  // namespace lyr
