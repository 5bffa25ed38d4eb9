// In a plane with the axis, a curve's distance from it is a height: where the curve crosses it is found by the curve's
// own functions on heights.

#include "parser/import/profile.h"

#include <cmath>
#include <numbers>

#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"

namespace lyr::importer {

namespace {

bool has_ends(const Curve& curve) {
    return !std::holds_alternative<Line>(curve) && !std::holds_alternative<Parabola>(curve) &&
           !std::holds_alternative<Hyperbola>(curve);
}

// Points that a curve's plane goes through, if it lies in one.
std::vector<Point3> hull_of(const Curve& curve) {
    if (const auto* spline = std::get_if<BSplineCurve>(&curve)) return spline->control_points;
    return {evaluate(curve, -0.5), evaluate(curve, 0), evaluate(curve, 0.5), evaluate(curve, 1)};
}

// Across the axis, in the plane of the curve; nothing if there is no such plane.
std::optional<Vector3> outward_in_plane(const Curve& curve, const Frame& axis) {
    const std::vector<Point3> points = hull_of(curve);
    Vector3 outward = Vector3::Zero();
    for (const Point3& p : points) {
        const Vector3 offset = p - axis.origin;
        const Vector3 across = offset - offset.dot(axis.z) * axis.z;
        if (across.norm() > outward.norm()) outward = across;
    }
    if (outward.norm() <= resolution_mm) return std::nullopt;
    outward.normalize();
    const Vector3 square = axis.z.cross(outward);
    const double reach_mm = points.empty() ? 0 : (points.back() - axis.origin).norm();
    const double closeness_mm = resolution_mm + angular_resolution_rad * reach_mm;
    for (const Point3& p : points) {
        if (std::abs((p - axis.origin).dot(square)) > closeness_mm) return std::nullopt;
    }
    return outward;
}

// Where a boundary point would be on the curve if it were turned into the curve's plane, on one side of the axis.
Point3 in_plane(const Point3& point, const Frame& axis, const Vector3& outward) {
    const Vector3 offset = point - axis.origin;
    const double height = offset.dot(axis.z);
    return axis.origin + height * axis.z + (offset - height * axis.z).norm() * outward;
}

// Parameters between which the curve lies on one side of the axis, the ends of `all` included.
std::vector<double> sides(const Curve& curve, const Frame& axis, const Vector3& outward,
                          const Stretch& all) {
    Eigen::Affine3d outward_up = Eigen::Affine3d::Identity();
    outward_up.linear().row(0) = axis.z;
    outward_up.linear().row(1) = outward.cross(axis.z);
    outward_up.linear().row(2) = outward;
    outward_up.translation() = -(outward_up.linear() * axis.origin);
    const Curve upright = transformed(curve, outward_up);
    std::vector<double> turns{all.low};
    for (const double t : height_extrema(upright, all.low, all.high)) turns.push_back(t);
    turns.push_back(all.high);
    std::vector<double> ends{all.low};
    for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
        const double before = evaluate(upright, turns[i]).z();
        const double after = evaluate(upright, turns[i + 1]).z();
        if (std::min(before, after) >= -resolution_mm || std::max(before, after) <= resolution_mm)
            continue;
        ends.push_back(parameter_at_height(upright, turns[i], turns[i + 1], 0));
    }
    ends.push_back(all.high);
    return ends;
}

// How far the points are from a stretch of the curve, all added up.
double misfit_mm(const Curve& curve, const Stretch& stretch, const Frame& axis,
                 const Vector3& outward, const std::vector<Point3>& points) {
    const Point3 middle = evaluate(curve, 0.5 * (stretch.low + stretch.high));
    const Vector3 side = (middle - axis.origin).dot(outward) < 0 ? Vector3(-outward) : outward;
    double sum = 0;
    for (const Point3& point : points) {
        const Point3 p = in_plane(point, axis, side);
        double t = invert(curve, p);
        if (const double turn = period(curve); turn > 0)
            t += turn * std::ceil((stretch.low - t) / turn);
        sum += (evaluate(curve, std::clamp(t, stretch.low, stretch.high)) - p).norm();
    }
    return sum;
}

}  // namespace

Stretch whole_stretch(const Curve& curve) {
    if (const auto* spline = std::get_if<BSplineCurve>(&curve))
        return {spline->domain_start(), spline->domain_end()};
    return {0, 2 * std::numbers::pi};
}

bool is_coplanar(const Curve& curve, const Frame& axis) {
    return outward_in_plane(curve, axis).has_value();
}

std::optional<Stretch> turned_stretch(const Curve& curve, const Frame& axis,
                                      const std::vector<Point3>& points,
                                      const std::optional<Point3>& hint) {
    if (points.empty() && !has_ends(curve)) return std::nullopt;
    const std::optional<Vector3> outward = outward_in_plane(curve, axis);
    if (const auto* line = std::get_if<Line>(&curve); line && !outward) {
        Stretch stretch;
        for (const Point3& p : points) {
            stretch.include((p - line->origin).dot(axis.z) / line->direction.dot(axis.z));
        }
        return stretch.widened();
    }
    if (!outward) return has_ends(curve) ? std::optional(whole_stretch(curve)) : std::nullopt;
    Stretch all;
    if (has_ends(curve)) {
        all = whole_stretch(curve);
    } else {
        for (const Point3& p : points) {
            all.include(invert(curve, in_plane(p, axis, *outward)));
            all.include(invert(curve, in_plane(p, axis, -*outward)));
        }
        all = all.widened();
    }
    std::vector<double> ends = sides(curve, axis, *outward, all);
    if (ends.size() == 2) return all;
    const double off_axis_mm = std::abs((evaluate(curve, all.low) - axis.origin).dot(*outward));
    if (const double turn = period(curve); turn > 0 && off_axis_mm > resolution_mm) {
        // A closed curve does not end at its seam.
        ends.pop_back();
        ends.front() = ends.back() - turn;
    }
    std::optional<Stretch> best;
    double least_mm = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const Stretch stretch{ends[i], ends[i + 1]};
        double misfit = misfit_mm(curve, stretch, axis, *outward, points);
        // Where both sides are alike, the hint decides.
        if (hint) misfit += resolution_mm * misfit_mm(curve, stretch, axis, *outward, {*hint});
        if (misfit < least_mm) {
            least_mm = misfit;
            best = stretch;
        }
    }
    return best;
}

}  // namespace lyr::importer
