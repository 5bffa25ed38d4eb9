#include "kernel/section/face_outline.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "kernel/brep/parameter_loops.h"
#include "kernel/brep/surface_foot.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/face_heights.h"

namespace lyr {
namespace {

// Steps that cut an edge into outline points: 48 a turn of a circle keeps them an eighth of a turn apart six times
// over. A B-spline gets as many for each bend that its control points can make; long ones bend less between two.
constexpr int steps_per_turn = 48;
constexpr int steps_per_control_point = 8, fully_stepped_points = 16;

// Feet of an outline's points on a B-spline surface, each found near the one before unless that is at a pole. One as far off as
// neighbours are apart is another place's neighbour.
std::vector<Point2> feet_of(const BSplineSurface& surface, const std::vector<Point3>& points,
                            const std::vector<Pole>& poles) {
    constexpr double doubtful_share = 0.125;
    SurfaceFoot foot(surface);
    std::vector<Point2> feet;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (pole_at(poles, points[i])) {
            feet.push_back(invert(surface, points[i]));
            foot = SurfaceFoot(surface);
            continue;
        }
        const double step_mm = i > 0 ? (points[i] - points[i - 1]).norm() : 0;
        foot.move_to(points[i],
                     std::max({resolution_mm, 2 * foot.distance_mm(), doubtful_share * step_mm}));
        feet.push_back(foot.uv());
    }
    return feet;
}

}  // namespace

int outline_steps(const Edge& edge) {
    if (std::holds_alternative<Line>(edge.curve)) return 1;
    if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
        const int points = static_cast<int>(spline->control_points.size());
        const int full = std::min(points, fully_stepped_points);
        return steps_per_control_point * full + points - full;
    }
    return steps_per_turn;
}

void append_outline(const Edge& edge, bool reversed, int steps, std::vector<Point3>& points) {
    const double from = reversed ? edge.t_end : edge.t_start;
    const double to = reversed ? edge.t_start : edge.t_end;
    for (int i = 0; i < steps; ++i) {
        points.push_back(evaluate(edge.curve, from + (to - from) * i / steps));
    }
}

std::vector<Coedge> bounding_coedges(const Model& model, const Face& face) {
    std::vector<Coedge> all;
    std::vector<std::pair<EdgeId, bool>> keys;
    for (std::uint32_t l = 0; l < face.loop_count; ++l) {
        const Loop& loop = model.loops[face.first_loop + l];
        for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
            all.push_back(model.coedges[loop.first_coedge + c]);
            keys.emplace_back(all.back().edge, all.back().reversed);
        }
    }
    std::sort(keys.begin(), keys.end());
    std::erase_if(all, [&](const Coedge& coedge) {
        return std::binary_search(keys.begin(), keys.end(),
                                  std::pair(coedge.edge, !coedge.reversed));
    });
    return all;
}

std::vector<Pole> poles_of(const Surface& surface) {
    if (const auto* cone = std::get_if<Cone>(&surface)) return {{apex_of(*cone), 0}};
    const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
    std::vector<Pole> poles;
    for (const bool along_u : {true, false}) {
        for (const bool at_end : {false, true}) {
            const auto pole = spline ? pole_of(**spline, along_u, at_end) : std::nullopt;
            if (pole) poles.push_back({*pole, along_u ? 0 : 1});
        }
    }
    return poles;
}

const Pole* pole_at(const std::vector<Pole>& poles, const Point3& point) {
    for (const Pole& pole : poles)
        if ((point - pole.point).norm() <= resolution_mm) return &pole;
    return nullptr;
}

std::vector<Point2> parameters_along(const Surface& surface, const std::vector<Point3>& points,
                                     const std::vector<Pole>& poles) {
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface))
        return feet_of(**spline, points, poles);
    std::vector<Point2> result;
    for (const Point3& point : points) result.push_back(invert(surface, point));
    return result;
}

std::array<double, 2> parameter_periods(const Surface& surface) {
    if (std::holds_alternative<Torus>(surface)) return {full_turn_rad, full_turn_rad};
    if (std::holds_alternative<Cylinder>(surface) || std::holds_alternative<Cone>(surface)) {
        return {full_turn_rad, 0};
    }
    const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
    if (!spline) return {0, 0};
    const BSplineSurface& s = **spline;
    return {s.closed_u ? s.end_u() - s.start_u() : 0, s.closed_v ? s.end_v() - s.start_v() : 0};
}

}  // namespace lyr
