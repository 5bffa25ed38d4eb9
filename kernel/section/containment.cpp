// See the header for the method; all of it is counting signed turns and crossings of outlines.

#include "kernel/section/containment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "kernel/contour/arc.h"
#include "kernel/section/face_outline.h"

namespace lyr {
namespace {

// The signed turn from one point of a loop to the next, in the surface's first parameter.
double turn_between(const Frame& frame, const Point3& a, const Point3& b) {
    const Point3 p = frame.to_local(a), q = frame.to_local(b);
    return std::atan2(p.x() * q.y() - p.y() * q.x(), p.x() * q.x() + p.y() * q.y());
}

int winding_around(const Frame& frame, const std::vector<Point3>& points) {
    double turn = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        turn += turn_between(frame, points[i], points[(i + 1) % points.size()]);
    }
    return static_cast<int>(std::lround(turn / full_turn_rad));
}

// A frame's handedness: +1, or -1 after a mirroring.
double handedness(const Frame& frame) {
    return frame.x.cross(frame.y).dot(frame.z) < 0 ? -1 : 1;
}

// The axis that loops can wind around on an unbounded surface.
const Frame* axis_frame(const Surface& surface) {
    if (const auto* cylinder = std::get_if<Cylinder>(&surface)) return &cylinder->frame;
    if (const auto* cone = std::get_if<Cone>(&surface)) return &cone->frame;
    return nullptr;
}

// An outline that passes a pole has its neighbours' values of the free parameter there, one after the other.
std::vector<Point2> turned_at_poles(const std::vector<Pole>& poles,
                                    const std::vector<Point3>& points,
                                    const std::vector<Point2>& uv) {
    std::vector<Point2> result;
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const Pole* pole = pole_at(poles, points[i]);
        result.push_back(uv[i]);
        if (!pole) continue;
        result.push_back(uv[i]);
        result[result.size() - 2][pole->free] = uv[(i + uv.size() - 1) % uv.size()][pole->free];
        result[result.size() - 1][pole->free] = uv[(i + 1) % uv.size()][pole->free];
    }
    return result;
}

// Each sheet of a torus whose tube crosses the axis is closed at two poles, like a sphere.
bool is_spindle(const Torus& torus) {
    return torus.minor_mm > torus.major_mm;
}

// Where a point of a sphere, or of a spindle torus' outer sheet, is on the unit sphere.
Vector3 globe_direction(const Surface& surface, const Point3& point) {
    if (const auto* sphere = std::get_if<Sphere>(&surface)) {
        return (point - sphere->frame.origin).normalized();
    }
    const Torus& torus = std::get<Torus>(surface);
    const Point3 local = torus.frame.to_local(point);
    const double across = std::hypot(local.x(), local.y());
    // From the sheet's equator, as an angle about the tube's centre.
    const double side = torus.inner_sheet ? -1 : 1;
    const double tube = std::atan2(local.z(), across - side * torus.major_mm);
    const double pole = std::acos(-side * torus.major_mm / torus.minor_mm);
    const double latitude = std::clamp(tube / pole, -1.0, 1.0) * full_turn_rad / 4;
    const double around = std::atan2(local.y(), local.x());
    return std::cos(latitude) *
               (std::cos(around) * torus.frame.x + std::sin(around) * torus.frame.y) +
           std::sin(latitude) * torus.frame.z;
}

// Whether a point of the unit sphere is to the left of an outline, seen from outside.
bool is_left_of(const Vector3& pole, const Outline& outline, double sense) {
    const Vector3 x = pole.unitOrthogonal(), y = pole.cross(x);
    const auto project = [&](const Vector3& ray) {
        return Point2(Point2(x.dot(ray), y.dot(ray)) / (1 - pole.dot(ray)));
    };
    double doubled_area = 0;
    Point2 before = project(outline.directions.back());
    for (const Vector3& direction : outline.directions) {
        const Point2 here = project(direction);
        doubled_area += cross(before, here);
        before = here;
    }
    // Seen from outside, projecting from the pole mirrors the globe: clockwise turns counter-clockwise.
    return sense * doubled_area >= 0;
}

// Rays run this far beside their point: edges along a parameter line have vertices exactly on the line through a point
// that was found on it, and a vertex on a ray would be met twice at one place. A metre away it is resolution_mm / 100.
constexpr double ray_offset_rad = 1e-12;

// Outlines are followed on the surface, which takes long: what turns by no more than a step of a circle's outline is one
// step of any, but no more steps than this together, lest the next foot be too far from the last.
constexpr double one_step_rad = full_turn_rad / 48;
constexpr std::size_t most_together = 8;

// Leaves out points after the first of these where the outline hardly turns.
void thin_out(std::vector<Point3>& points, std::size_t first) {
    std::size_t kept = first, together = 0;
    double turn = 0;
    for (std::size_t i = first + 1; i < points.size(); ++i) {
        ++together;
        const bool is_last = i + 1 == points.size();
        const Vector3 before = points[i] - points[i - 1];
        const Vector3 after = is_last ? before : Vector3(points[i + 1] - points[i]);
        turn += std::atan2(before.cross(after).norm(), before.dot(after));
        if (turn <= one_step_rad && together < most_together && !is_last) continue;
        points[++kept] = points[i];
        turn = 0;
        together = 0;
    }
    points.resize(std::min(points.size(), kept + 1));
}

}  // namespace

Containment::Containment(const Model& model, FaceId id, const std::vector<double>& vertex_level_mm,
                         bool for_parameters)
    : surface_(model[id].surface),
      for_parameters_(for_parameters),
      same_sense_(model[id].same_sense),
      period_(parameter_periods(surface_)) {
    std::vector<Coedge> rest = bounding_coedges(model, model[id]);
    while (!rest.empty()) {
        std::vector<Point3> points;
        const VertexId origin = model.start_of(rest.front());
        for (auto next = rest.begin(); next != rest.end();) {
            const Edge& edge = model[next->edge];
            const std::size_t first = points.size();
            append_outline(edge, next->reversed, outline_steps(edge), points);
            if (std::holds_alternative<BSplineCurve>(edge.curve)) thin_out(points, first);
            const VertexId at = model.end_of(*next);
            rest.erase(next);
            if (at == origin) break;
            next = std::find_if(rest.begin(), rest.end(),
                                [&](const Coedge& coedge) { return model.start_of(coedge) == at; });
        }
        outlines_.push_back(prepared(points, vertex_level_mm[origin.value]));
    }
}

Outline Containment::prepared(const std::vector<Point3>& points, double height_mm) const {
    Outline outline{.height_mm = height_mm, .winding = 0, .directions = {}, .steps = {}};
    const auto* torus = std::get_if<Torus>(&surface_);
    if (std::holds_alternative<Sphere>(surface_) || (torus && is_spindle(*torus))) {
        for (const Point3& p : points) outline.directions.push_back(globe_direction(surface_, p));
        return outline;
    }
    const Frame* axis = axis_frame(surface_);
    if (axis) outline.winding = winding_around(*axis, points);
    if (!axis || for_parameters_) {
        const auto poles = for_parameters_ ? poles_of(surface_) : std::vector<Pole>();
        const std::vector<Point2> uv =
            turned_at_poles(poles, points, parameters_along(surface_, points, poles));
        for (std::size_t i = 0; i < uv.size(); ++i) {
            const Point2 &from = uv[i], &to = uv[(i + 1) % uv.size()];
            outline.steps.push_back({from,
                                     to,
                                     {short_way(to.x() - from.x(), period_[0]),
                                      short_way(to.y() - from.y(), period_[1])}});
        }
    }
    return outline;
}

bool Containment::holds(const Point3& point, double z_mm) const {
    if (std::holds_alternative<Cylinder>(surface_)) return on_cylinder(z_mm);
    if (const auto* cone = std::get_if<Cone>(&surface_)) return on_cone(*cone, z_mm);
    if (std::holds_alternative<Sphere>(surface_)) return on_sphere(z_mm);
    if (std::holds_alternative<Plane>(surface_)) return false;
    const auto* torus = std::get_if<Torus>(&surface_);
    return torus && is_spindle(*torus) ? on_spindle(point)
                                       : holds_parameters(invert(surface_, point));
}

bool Containment::holds_apex() const {
    int winding = 0;
    for (const Outline& outline : outlines_) winding += outline.winding;
    return winding != 0;
}

bool Containment::on_cylinder(double z_mm) const {
    int below = 0;
    for (const Outline& outline : outlines_) {
        if (outline.height_mm <= z_mm) below += outline.winding;
    }
    return below != 0;
}

bool Containment::on_cone(const Cone& cone, double z_mm) const {
    const bool unbounded_above = cone.frame.z.z() > 0;
    int winding = 0;
    for (const Outline& outline : outlines_) {
        if ((outline.height_mm > z_mm) == unbounded_above) winding += outline.winding;
    }
    return winding != 0;
}

bool Containment::on_sphere(double z_mm) const {
    const double sense = same_sense_ ? 1 : -1;
    return std::all_of(outlines_.begin(), outlines_.end(), [&](const Outline& outline) {
        const double side = outline.height_mm <= z_mm ? 1 : -1;
        return is_left_of(side * Vector3::UnitZ(), outline, sense);
    });
}

bool Containment::on_spindle(const Point3& point) const {
    const Vector3 direction = globe_direction(surface_, point);
    const double sense = same_sense_ ? 1 : -1;
    return std::all_of(outlines_.begin(), outlines_.end(), [&](const Outline& outline) {
        return is_left_of(direction, outline, sense);
    });
}

// +1 if the face is on the left of its loops in the (u, v) plane.
double Containment::sense_of_parameters() const {
    const double sense = same_sense_ ? 1 : -1;
    if (const auto* torus = std::get_if<Torus>(&surface_)) return sense * handedness(torus->frame);
    if (const auto* axis = axis_frame(surface_)) return sense * handedness(*axis);
    return std::get<SharedBSplineSurface>(surface_)->mirrored ? -sense : sense;
}

bool Containment::holds_parameters(const Point2& uv) const {
    const auto* torus = std::get_if<Torus>(&surface_);
    if (torus && is_spindle(*torus)) return on_spindle(evaluate(surface_, uv));
    const Point2 at = uv + Point2::Constant(ray_offset_rad);
    const double sense = sense_of_parameters();
    // fixed 0: along v at constant u; fixed 1: along u at constant v.
    for (const int fixed : {0, 1}) {
        const int along = 1 - fixed;
        const double turn = period_[static_cast<std::size_t>(along)];
        const double across = period_[static_cast<std::size_t>(fixed)];
        double nearest = 0;
        bool inside = false, met = false;
        for (const Outline& outline : outlines_) {
            for (const UvStep& step : outline.steps) {
                // Each point's side is found from the point alone, so that no step between two is
                // missed; the far side, where the parameter jumps, is no crossing.
                const double start = short_way(step.from[fixed] - at[fixed], across);
                const double end = short_way(step.to[fixed] - at[fixed], across);
                if ((start <= 0) == (end <= 0)) continue;
                if (across > 0 && std::abs(end - start) > across / 2) continue;
                double ahead =
                    step.from[along] + step.by[along] * (start / (start - end)) - at[along];
                if (turn > 0) ahead -= turn * std::floor(ahead / turn);
                if (met && std::abs(ahead) >= nearest) continue;
                nearest = std::abs(ahead);
                met = true;
                // Left of +u is +v; left of +v is -u. Behind the point it is the far side that counts.
                const double left = (fixed == 0 ? 1 : -1) * sense * (end - start);
                inside = (left < 0) == (ahead >= 0);
            }
        }
        if (met) return inside;
    }
    for (const Outline& outline : outlines_) {
        double doubled_area = 0;
        Point2 from = Point2::Zero();
        for (const UvStep& step : outline.steps) {
            const Point2 to = from + step.by;
            doubled_area += cross(from, to);
            from = to;
        }
        if (sense * doubled_area > 0) return false;
    }
    return true;
}

}  // namespace lyr
