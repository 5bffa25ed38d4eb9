#include "kernel/section/flatness.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/tolerance.h"
#include "kernel/section/containment.h"
#include "kernel/section/flat_cells.h"

namespace lyr {
namespace {

// What rises by less than level_rise_mm and is not this flat is a sliver on a slope, not a level face.
constexpr double least_level_flatness = 0.999;

double axis_lean(const Frame& frame) {
    return frame.z.head<2>().norm();
}

bool is_upright(const Frame& frame) {
    return axis_lean(frame) <= angular_resolution_rad;
}

bool is_level(const Frame& frame) {
    return std::abs(frame.z.z()) <= angular_resolution_rad;
}

// Flatness that grows with the distance from a height: that of spheres, level cylinders and upright tori.
struct Bowl {
    double middle_mm, radius_mm;
};

std::optional<Bowl> bowl_of(const Surface& surface) {
    if (const auto* sphere = std::get_if<Sphere>(&surface))
        return Bowl{sphere->frame.origin.z(), sphere->radius_mm};
    const auto* cylinder = std::get_if<Cylinder>(&surface);
    if (cylinder && is_level(cylinder->frame))
        return Bowl{cylinder->frame.origin.z(), cylinder->radius_mm};
    const auto* torus = std::get_if<Torus>(&surface);
    if (torus && is_upright(torus->frame)) return Bowl{torus->frame.origin.z(), torus->minor_mm};
    return std::nullopt;
}

// The same flatness everywhere.
std::optional<double> constant_flatness(const Surface& surface) {
    if (const auto* plane = std::get_if<Plane>(&surface)) return std::abs(plane->frame.z.z());
    const auto* cylinder = std::get_if<Cylinder>(&surface);
    if (cylinder && is_upright(cylinder->frame)) return 0;
    const auto* cone = std::get_if<Cone>(&surface);
    if (cone && is_upright(cone->frame)) return std::sin(cone->half_angle_rad);
    return std::nullopt;
}

// Of closed forms: by how much flatness rises over one part.
constexpr double bowl_step = 1.0 / 128;

void append_bowl(const Bowl& bowl, HeightRange heights, const FlatnessLimits& limits,
                 std::vector<FlatPart>& parts) {
    const double last = std::min(limits.most, 1.0);
    if (!(limits.least < last)) return;
    const double first = std::clamp(limits.height_mm / bowl.radius_mm, limits.least, last);
    for (const double side : {-1.0, 1.0}) {
        const auto add = [&](double from, double to, double flatness) {
            const auto [low, high] = std::minmax({bowl.middle_mm + side * from * bowl.radius_mm,
                                                  bowl.middle_mm + side * to * bowl.radius_mm});
            const FlatPart part{std::max(low, heights.bottom_mm), std::min(high, heights.top_mm),
                                flatness};
            if (part.bottom_mm < part.top_mm) parts.push_back(part);
        };
        if (first > limits.least) add(0, first, first);
        double from = first;
        while (from < last) {
            const double to = std::min(from * (1 + bowl_step), last);
            add(from, to, to);
            from = to;
        }
        // Round-off may put the highest point a little beyond the radius.
        add(from, 2, 1);
    }
}

double highest_flatness(const Surface& surface) {
    const auto* cylinder = std::get_if<Cylinder>(&surface);
    return cylinder ? axis_lean(cylinder->frame) : 1;
}

bool is_level_face(const Surface& surface) {
    if (const auto* plane = std::get_if<Plane>(&surface))
        return std::abs(plane->frame.z.z()) >= least_level_flatness;
    const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
    if (!spline) return false;
    const auto [low, high] =
        std::minmax_element((*spline)->control_points.begin(), (*spline)->control_points.end(),
                            [](const Point3& a, const Point3& b) { return a.z() < b.z(); });
    return high->z() - low->z() < level_rise_mm;
}

}  // namespace

FlatnessSurvey::FlatnessSurvey(const Model& model, const FlatnessLimits& limits)
    : model_(model),
      limits_(limits),
      edges_(monotone_pieces(model)),
      loops_(loop_heights(model, edges_)) {}

// Of a face whose highest and lowest points are on its loops, or are level points of its surface.
HeightRange FlatnessSurvey::whole_heights(FaceId id) const {
    const Face& face = model_[id];
    HeightRange range = loops_[id.value];
    const std::vector<Point3> points = level_points(face.surface);
    const auto* cone = std::get_if<Cone>(&face.surface);
    if (points.empty() && !cone) return range;
    const Containment containment(model_, id, edges_.vertex_level_mm);
    const auto extend = [&](double z) {
        range = {std::min(range.bottom_mm, z), std::max(range.top_mm, z)};
    };
    for (const Point3& point : points)
        if (containment.holds(point, point.z())) extend(point.z());
    if (cone && containment.holds_apex()) extend(apex_of(*cone).z());
    return range;
}

FaceFlatness FlatnessSurvey::of(FaceId id) const {
    const Surface& surface = model_[id].surface;
    const HeightRange loops = loops_[id.value];
    FaceFlatness result;
    if (const auto flatness = constant_flatness(surface)) {
        const HeightRange heights = whole_heights(id);
        if (heights.top_mm - heights.bottom_mm < level_rise_mm) {
            if (is_level_face(surface)) result.level_mm = (heights.bottom_mm + heights.top_mm) / 2;
        } else if (*flatness > limits_.least) {
            result.parts.push_back(
                {heights.bottom_mm, heights.top_mm, *flatness >= limits_.most ? 1 : *flatness});
        }
    } else if (const auto bowl = bowl_of(surface)) {
        append_bowl(*bowl, whole_heights(id), limits_, result.parts);
    } else if (is_level_face(surface)) {
        result.level_mm = (loops.bottom_mm + loops.top_mm) / 2;
    } else if (highest_flatness(surface) > limits_.least) {
        result.parts = flat_cells(model_, id, edges_.vertex_level_mm, whole_heights(id), limits_);
    }
    return result;
}

}  // namespace lyr
