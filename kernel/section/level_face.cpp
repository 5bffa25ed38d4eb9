#include "kernel/section/level_face.h"

#include <utility>

#include "kernel/contour/fit.h"
#include "kernel/contour/turned_round.h"
#include "kernel/section/leaning.h"

namespace lyr {
namespace {

void append_edge(const Model& model, const Coedge& coedge, const Tolerance& tolerance, Path& path) {
    const Edge& edge = model[coedge.edge];
    const Point2 end = model[model.end_of(coedge)].point.head<2>();
    if (std::holds_alternative<Line>(edge.curve)) {
        path.segments.push_back({end});
        return;
    }
    double first = edge.t_start, last = edge.t_end;
    if (coedge.reversed) std::swap(first, last);
    const PlaneCurve curve = [&](double share) {
        const auto [point, tangent] = point_and_tangent(edge.curve, first + share * (last - first));
        const Vector2 along = (last - first) * tangent.head<2>();
        return CurvePoint{point.head<2>(), along.normalized()};
    };
    // Of a closed edge a half has ends that differ.
    const Point2 start = path.segments.empty() ? path.start : path.segments.back().end;
    const Point2 middle = curve(0.5).point;
    fit_arcs(curve, 0, 0.5, start, middle, tolerance.fit_mm(), path.segments);
    fit_arcs(curve, 0.5, 1, middle, end, tolerance.fit_mm(), path.segments);
}

}  // namespace

std::optional<LevelFace> level_face(const Model& model, FaceId id, const Tolerance& tolerance) {
    const Face& face = model[id];
    const auto* plane = std::get_if<Plane>(&face.surface);
    if (!plane || plane->frame.z.head<2>().norm() > lean_resolution_rad) return std::nullopt;
    LevelFace result{.z_mm = plane->frame.origin.z(),
                     .looks_down = (plane->frame.z.z() < 0) == face.same_sense,
                     .region = {}};
    for (std::uint32_t l = 0; l < face.loop_count; ++l) {
        const Loop& loop = model.loops[face.first_loop + l];
        if (loop.coedge_count == 0) continue;
        const Coedge* coedges = &model.coedges[loop.first_coedge];
        Path path{model[model.start_of(coedges[0])].point.head<2>(), {}};
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c)
            append_edge(model, coedges[c], tolerance, path);
        path.segments.back().end = path.start;
        if (result.looks_down) path = std::get<Path>(turned_round(Contour(path)));
        if (auto contour = simplified(std::move(path), tolerance.trace_mm()))
            result.region.push_back(std::move(*contour));
    }
    return result;
}

}  // namespace lyr
