// Sides wait in a table, by their two vertices, for the ones that run against them.

#include "kernel/brep/polygon_sides.h"

#include <algorithm>

namespace lyr {

VertexId PolygonSides::vertex_at(const Point3& point, SourceId source) {
    const std::uint32_t number = points_.number_of(point);
    if (number == vertices_.size()) {
        vertices_.emplace_back(model_->vertices.size());
        model_->vertices.push_back({point, source});
    }
    return vertices_[number];
}

Coedge PolygonSides::of_side(VertexId from, VertexId to, SourceId source) {
    const TripleKey key{std::min(from.value, to.value), std::max(from.value, to.value), 0};
    std::vector<Waiting>& waiting = waiting_[key];
    const auto opposite = std::find_if(waiting.begin(), waiting.end(),
                                       [&](const Waiting& w) { return w.from != from; });
    if (opposite != waiting.end()) {
        const EdgeId edge = opposite->edge;
        waiting.erase(opposite);
        return {edge, true};
    }
    const EdgeId edge(model_->edges.size());
    const Point3& start = (*model_)[from].point;
    const Vector3 along = (*model_)[to].point - start;
    model_->edges.push_back({Line{start, along.normalized()}, 0, along.norm(), from, to, source});
    waiting.push_back({edge, from});
    return {edge, false};
}

std::size_t PolygonSides::open_count() const {
    std::size_t count = 0;
    for (const auto& [key, waiting] : waiting_) count += waiting.size();
    return count;
}

void PolygonSides::clear() {
    points_ = {};
    vertices_.clear();
    waiting_.clear();
}

Plane plane_of(const std::vector<Point3>& corners) {
    Frame frame;
    frame.origin = corners.front();
    Vector3 doubled_area = Vector3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vector3 here = corners[i] - frame.origin;
        const Vector3 next = corners[(i + 1) % corners.size()] - frame.origin;
        doubled_area += here.cross(next);
        if (next.norm() > frame.x.norm() || i == 0) frame.x = next;
    }
    frame.x.normalize();
    frame.z = doubled_area - doubled_area.dot(frame.x) * frame.x;
    // Smaller than the round-off of the products that it is the sum of.
    constexpr double round_off = 1e-14;
    double longest = 0;
    for (const Point3& p : corners) longest = std::max(longest, (p - frame.origin).norm());
    const bool is_flat = frame.z.norm() <= round_off * longest * longest;
    frame.z = is_flat ? frame.x.unitOrthogonal() : frame.z.normalized();
    frame.y = frame.z.cross(frame.x);
    return {frame};
}

}  // namespace lyr
