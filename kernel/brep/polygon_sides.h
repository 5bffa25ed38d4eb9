// Straight edges between the polygons of a solid that states polygons, not edges: two that run along each other in
// opposite directions share one.
//
// Contract
//  1. of_side(a, b) is a use of an edge from a to b that no earlier call has given out in this direction, shared with
//     an earlier side from b to a if one is left. Where more than two polygons meet, edges are shared in pairs.
//  2. vertex_at() gives one vertex for each point: the same for the same three numbers.

#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/brep/point_table.h"

namespace lyr {

class PolygonSides {
public:
    explicit PolygonSides(Model& model) : model_(&model) {}

    VertexId vertex_at(const Point3& point, SourceId source);
    Coedge of_side(VertexId from, VertexId to, SourceId source);

    // Edges that have been given out in one direction only.
    std::size_t open_count() const;

    // Forgets vertices and edges: the next solid has its own.
    void clear();

private:
    // Edges between two vertices that wait for their other side, and which side has been given out.
    struct Waiting {
        EdgeId edge;
        VertexId from;
    };

    Model* model_;
    PointTable points_;
    std::vector<VertexId> vertices_;  // by the points' numbers
    std::unordered_map<TripleKey, std::vector<Waiting>, TripleKey::Hash> waiting_;
};

// The plane that a polygon is best seen flat from, its normal such that the corners run counter-clockwise; for one
// without area, any plane along it.
Plane plane_of(const std::vector<Point3>& corners);

}  // namespace lyr
