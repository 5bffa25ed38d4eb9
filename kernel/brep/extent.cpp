#include "kernel/brep/extent.h"

#include <algorithm>
#include <span>

#include "kernel/brep/defect.h"

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

Status check_extent(const Model& model) {
    for (const Vertex& vertex : model.vertices) {
        if (Status checked = check({&vertex.point, 1}, vertex.source); !checked) return checked;
    }
    for (const Edge& edge : model.edges) {
        if (Status checked = check(control_points(edge.curve), edge.source); !checked)
            return checked;
    }
    for (const Face& face : model.faces) {
        if (Status checked = check(control_points(face.surface), face.source); !checked)
            return checked;
    }
    return Done{};
}

}  // namespace lyr
