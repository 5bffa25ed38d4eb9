#include "kernel/section/face_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<HeightRange> edge_ranges(const Model& model, const MonotoneEdges& edges) {
    std::vector<HeightRange> ranges(model.edges.size(), {infinity, -infinity});
    for (const MonotonePiece& piece : edges.pieces) {
        HeightRange& range = ranges[piece.edge.value];
        range.bottom_mm = std::min(range.bottom_mm, piece.bottom_mm);
        range.top_mm = std::max(range.top_mm, piece.top_mm);
    }
    return ranges;
}

HeightRange range_of_loops(const Model& model, const Face& face, const MonotoneEdges& edges,
                           const std::vector<HeightRange>& edge_range) {
    HeightRange range{infinity, -infinity};
    for (std::uint32_t l = 0; l < face.loop_count; ++l) {
        const Loop& loop = model.loops[face.first_loop + l];
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            const EdgeId id = model.coedges[loop.first_coedge + c].edge;
            const double level = edges.vertex_level_mm[model[id].start.value];
            range.bottom_mm = std::min({range.bottom_mm, level, edge_range[id.value].bottom_mm});
            range.top_mm = std::max({range.top_mm, level, edge_range[id.value].top_mm});
        }
    }
    return range;
}

}  // namespace

std::vector<HeightRange> loop_heights(const Model& model, const MonotoneEdges& edges) {
    const std::vector<HeightRange> of_edges = edge_ranges(model, edges);
    std::vector<HeightRange> heights;
    for (const Face& face : model.faces)
        heights.push_back(range_of_loops(model, face, edges, of_edges));
    return heights;
}

Point3 apex_of(const Cone& cone) {
    return cone.frame.origin - cone.radius_mm / std::tan(cone.half_angle_rad) * cone.frame.z;
}

// Points where a closed surface is level, one on each connected set of them, and a spindle torus' poles.
std::vector<Point3> level_points(const Surface& surface) {
    if (const auto* sphere = std::get_if<Sphere>(&surface)) {
        const Vector3 up = sphere->radius_mm * Vector3::UnitZ();
        return {sphere->frame.origin + up, sphere->frame.origin - up};
    }
    const auto* torus = std::get_if<Torus>(&surface);
    if (!torus) return {};
    const Vector3& axis = torus->frame.z;
    const double lean = axis.head<2>().norm();
    const Vector3 across = lean > angular_resolution_rad
                               ? Vector3((Vector3::UnitZ() - axis.z() * axis) / lean)
                               : axis.unitOrthogonal();
    std::vector<Point3> points;
    for (const double side : {1.0, -1.0}) {
        for (const double up : {1.0, -1.0}) {
            const Vector3 tube = up * torus->minor_mm * Vector3::UnitZ();
            const bool beyond_axis = torus->major_mm + side * tube.dot(across) < 0;
            if (beyond_axis != torus->inner_sheet) continue;
            points.push_back(torus->frame.origin + side * torus->major_mm * across + tube);
        }
    }
    const double pole2 = torus->minor_mm * torus->minor_mm - torus->major_mm * torus->major_mm;
    if (pole2 > 0) {
        points.push_back(torus->frame.origin + std::sqrt(pole2) * axis);
        points.push_back(torus->frame.origin - std::sqrt(pole2) * axis);
    }
    return points;
}

}  // namespace lyr
