// Geometry is transformed in place; a mirroring also reverses every loop, for left and right change sides.

#include "kernel/brep/placement.h"

#include <algorithm>

namespace lyr {
namespace {

void reverse_loops(Model& model) {
    for (Coedge& coedge : model.coedges) coedge.reversed = !coedge.reversed;
    for (const Loop& loop : model.loops) {
        const auto first = model.coedges.begin() + loop.first_coedge;
        std::reverse(first, first + loop.coedge_count);
    }
}

}  // namespace

Model transformed(Model model, const Eigen::Affine3d& transform) {
    const double scale = std::cbrt(std::abs(transform.linear().determinant()));
    for (Vertex& vertex : model.vertices) vertex.point = transform * vertex.point;
    for (Edge& edge : model.edges) {
        edge.curve = transformed(edge.curve, transform);
        // A line's parameter is a length.
        if (std::holds_alternative<Line>(edge.curve)) {
            edge.t_start *= scale;
            edge.t_end *= scale;
        }
    }
    for (Face& face : model.faces) face.surface = transformed(face.surface, transform);
    if (transform.linear().determinant() < 0) reverse_loops(model);
    model.uncertainty_mm *= scale;
    return model;
}

Eigen::Affine3d turned_up(const Vector3& up) {
    return Eigen::Affine3d(Eigen::Quaterniond::FromTwoVectors(up.normalized(), Vector3::UnitZ()));
}

}  // namespace lyr
