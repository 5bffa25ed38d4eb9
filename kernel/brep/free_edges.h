// Edges that one face uses once: where a shell is open, and what sewing has to find partners for.

#pragma once

#include <optional>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

struct FreeEdge {
    EdgeId edge;
    FaceId face;
    bool reversed;  // as the face uses it
};

// In the order of faces and loops.
std::vector<FreeEdge> free_edges(const Model& model);

// The parameter of the edge's point nearest to `point`, between its ends. On a closed curve it is looked for there first.
double nearest_parameter(const Edge& edge, const Point3& point);

// At a share of the way, in parameters, from start to end.
Point3 point_on(const Edge& edge, double share);

// Of a chain of chords: never longer than the edge.
double rough_length_mm(const Edge& edge);

}  // namespace lyr
