#include "kernel/brep/extent.h"

#include <algorithm>
#include <span>

#include "kernel/brep/defect.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// Also what is no number.
bool is_beyond(const Point3& point) {
    return !(point.cwiseAbs().maxCoeff() <= largest_coordinate_mm);
}

std::span<const Point3> control_points(const Curve& curve) {
    const auto* spline = std::get_if<BSplineCurve>(&curve);
    return spline ? std::span<const Point3>(spline->control_points) : std::span<const Point3>();
}

std::span<const Point3> control_points(const Surface& surface) {
    const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
    return spline ? std::span<const Point3>((*spline)->control_points) : std::span<const Point3>();
}

Status check(std::span<const Point3> points, SourceId source) {
    const auto beyond = std::find_if(points.begin(), points.end(), is_beyond);
    if (beyond == points.end()) return Done{};
    return defect(Severity::error,
                  "a point lies more than 1 km from the origin, where coordinates are too coarse: "
                  "is it damaged, or the file's length unit wrong?",
                  source, *beyond);
}

}  // namespace

Status check_extent(const Vertex& vertex) {
    return check({&vertex.point, 1}, vertex.source);
}

Status check_extent(const Edge& edge) {
    if (Status checked = check(control_points(edge.curve), edge.source); !checked) return checked;
    const Point3 ends[] = {evaluate(edge.curve, edge.t_start), evaluate(edge.curve, edge.t_end)};
    return check(ends, edge.source);
}

Status check_extent(const Face& face) {
    return check(control_points(face.surface), face.source);
}

Status check_places(const Model& model) {
    Eigen::AlignedBox3d box;
    for (const Vertex& vertex : model.vertices) {
        if (Status checked = check_extent(vertex); !checked) return checked;
        box.extend(vertex.point);
    }
    const double extent_mm = box.isEmpty() ? 0 : box.diagonal().norm();
    for (const Edge& edge : model.edges) {
        const Point3 first = evaluate(edge.curve, edge.t_start),
                     last = evaluate(edge.curve, edge.t_end);
        const double off_mm = std::max((first - model[edge.start].point).norm(),
                                       (last - model[edge.end].point).norm());
        if (off_mm <= std::max({extent_mm, (last - first).norm(), resolution_mm})) continue;
        return defect(Severity::error,
                      "the edge lies " + in_mm(off_mm) +
                          " off its vertices, more than they are apart: is a coordinate or a "
                          "radius damaged?",
                      edge.source, model[edge.start].point);
    }
    return Done{};
}

}  // namespace lyr
