// See the header for the method; all of it is counting signed turns and crossings of outlines.

#include "kernel/section/containment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/contour/arc.h"

namespace lyr {
namespace {

constexpr double full_turn_rad = 2 * std::numbers::pi;

// Steps that cut an edge into outline points: 48 a turn of a circle keeps them an eighth of a turn
// apart six times over; a B-spline gets as many between neighbouring control points' worth of bending.
constexpr int steps_per_turn = 48;
constexpr int steps_per_control_point = 8;

int outline_steps(const Edge& edge) {
    if (std::holds_alternative<Line>(edge.curve)) return 1;
    if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
        return steps_per_control_point * static_cast<int>(spline->control_points.size());
    }
    return steps_per_turn;
}

void append_outline(const Edge& edge, bool reversed, std::vector<Point3>& points) {
    const int steps = outline_steps(edge);
    const double from = reversed ? edge.t_end : edge.t_start;
    const double to = reversed ? edge.t_start : edge.t_end;
    for (int i = 0; i < steps; ++i) {
        points.push_back(evaluate(edge.curve, from + (to - from) * i / steps));
    }
}

// The face's coedges in order, without those that come in both directions.
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

UvStep uv_step(const Surface& surface, const Point3& a, const Point3& b) {
    const Point2 from = invert(surface, a), to = invert(surface, b);
    return {from,
            to,
            {std::remainder(to.x() - from.x(), full_turn_rad),
             std::remainder(to.y() - from.y(), full_turn_rad)}};
}

}  // namespace

Containment::Containment(const Model& model, FaceId id, const std::vector<double>& vertex_level_mm)
    : surface_(model[id].surface), same_sense_(model[id].same_sense) {
    std::vector<Coedge> rest = bounding_coedges(model, model[id]);
    while (!rest.empty()) {
        std::vector<Point3> points;
        const VertexId origin = model.start_of(rest.front());
        for (auto next = rest.begin(); next != rest.end();) {
            append_outline(model[next->edge], next->reversed, points);
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
    } else if (torus) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            outline.steps.push_back(uv_step(surface_, points[i], points[(i + 1) % points.size()]));
        }
    } else {
        std::visit(
            [&](const auto& s) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(s)>, SharedBSplineSurface>) {
                    outline.winding = winding_around(s.frame, points);
                }
            },
            surface_);
    }
    return outline;
}

bool Containment::holds(const Point3& point, double z_mm) const {
    if (std::holds_alternative<Cylinder>(surface_)) return on_cylinder(z_mm);
    if (const auto* cone = std::get_if<Cone>(&surface_)) return on_cone(*cone, z_mm);
    if (std::holds_alternative<Sphere>(surface_)) return on_sphere(z_mm);
    const auto* torus = std::get_if<Torus>(&surface_);
    if (!torus) return false;
    return is_spindle(*torus) ? on_spindle(point) : on_torus(point);
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

bool Containment::on_torus(const Point3& point) const {
    const Point2 at = invert(surface_, point) + Point2::Constant(ray_offset_rad);
    const double sense = (same_sense_ ? 1 : -1) * handedness(std::get<Torus>(surface_).frame);
    // axis 0: along the tube at constant u; axis 1: around at constant v.
    for (const int fixed : {0, 1}) {
        const int along = 1 - fixed;
        double nearest = full_turn_rad;
        bool face_before = false, met = false;
        for (const Outline& outline : outlines_) {
            for (const UvStep& step : outline.steps) {
                // Each point's side is found from the point alone, so that no step between two is
                // missed; the far side, where the angle jumps, is no crossing.
                const double start = std::remainder(step.from[fixed] - at[fixed], full_turn_rad);
                const double end = std::remainder(step.to[fixed] - at[fixed], full_turn_rad);
                if ((start <= 0) == (end <= 0) || std::abs(end - start) > full_turn_rad / 2) {
                    continue;
                }
                const double where =
                    step.from[along] + step.by[along] * (start / (start - end)) - at[along];
                const double ahead = where - full_turn_rad * std::floor(where / full_turn_rad);
                if (met && ahead >= nearest) continue;
                nearest = ahead;
                met = true;
                // Left of +u is +v; left of +v is -u.
                const double left = (fixed == 0 ? 1 : -1) * sense * (end - start);
                face_before = left < 0;
            }
        }
        if (met) return face_before;
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
