// Curves moved along a line or turned about an axis.

#include "parser/import/swept.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/bounded_curve.h"
#include "parser/import/curves.h"
#include "parser/import/placement.h"
#include "parser/import/profile.h"

namespace lyr::importer {

namespace {

Diagnostic degenerate(const File& file, InstanceIndex instance) {
    return file.error(instance, named(file, instance) + ": the sweep covers no area");
}

// The parameters of a curve that a sweep along `direction` needs: all, or for a curve without ends those of the
// boundary's points seen along it.
Stretch swept_stretch(const Curve& curve, const Vector3& direction,
                      const std::vector<Point3>& points) {
    const auto seen = [&](const Frame& frame, const auto& parameter) {
        Stretch stretch;
        const double lean = direction.dot(frame.z);
        for (const Point3& p : points) {
            const double height = (p - frame.origin).dot(frame.z);
            stretch.include(parameter((p - height / lean * direction - frame.origin).dot(frame.y)));
        }
        return stretch.widened();
    };
    if (const auto* parabola = std::get_if<Parabola>(&curve)) {
        return seen(parabola->frame, [&](double y) { return y / (2 * parabola->focal_mm); });
    }
    if (const auto* hyperbola = std::get_if<Hyperbola>(&curve)) {
        return seen(hyperbola->frame,
                    [&](double y) { return std::asinh(y / hyperbola->semi_y_mm); });
    }
    return whole_stretch(curve);
}

std::optional<StatedSurface> elementary_extrusion(const Curve& curve, const Vector3& direction) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        Frame frame;
        frame.origin = line->origin;
        frame.z = line->direction.cross(direction).normalized();
        frame.x = line->direction;
        frame.y = frame.z.cross(frame.x);
        return StatedSurface{Plane{frame}};
    }
    const auto* circle = std::get_if<Circle>(&curve);
    if (circle == nullptr || circle->frame.z.cross(direction).norm() > angular_resolution_rad)
        return std::nullopt;
    return StatedSurface{Cylinder{circle->frame, circle->radius_mm},
                         circle->frame.z.dot(direction) > 0};
}

StatedSurface spline_extrusion(const Curve& curve, const Vector3& direction,
                               const std::vector<Point3>& points) {
    const Stretch along = swept_stretch(curve, direction, points);
    BSplineCurve spline = rational(curve, along.low, along.high);
    Stretch of_curve, of_points;
    for (const Point3& c : spline.control_points) of_curve.include(c.dot(direction));
    for (const Point3& p : points) of_points.include(p.dot(direction));
    const Stretch reach =
        Stretch{of_points.low - of_curve.high, of_points.high - of_curve.low}.widened();
    for (Point3& c : spline.control_points) c += reach.low * direction;
    return stated(extruded(spline, (reach.high - reach.low) * direction));
}

// --- revolution ---

Frame frame_about(const Frame& axis, const Point3& origin) {
    Frame frame = axis;
    frame.origin = origin;
    return frame;
}

// The line's own distance from the axis decides between cylinder, cone and plane; a skew one is neither.
std::optional<StatedSurface> turned_line(const Line& line, const Frame& axis) {
    const Vector3 offset = axis.to_local(line.origin);
    const double rise = line.direction.dot(axis.z);
    const Vector2 flat(line.direction.dot(axis.x), line.direction.dot(axis.y));
    const double lean = flat.norm();
    if (std::abs(rise) <= angular_resolution_rad) {
        // d/du x d/dv looks down where the line leads away from the axis.
        const bool leads_away = flat.dot(offset.head<2>()) >= -resolution_mm;
        Frame frame = frame_about(axis, line.origin);
        if (leads_away) {
            frame.z = -frame.z;
            frame.y = -frame.y;
        }
        return StatedSurface{Plane{frame}};
    }
    if (lean <= angular_resolution_rad) {
        const double radius_mm = offset.head<2>().norm();
        if (radius_mm <= resolution_mm) return std::nullopt;
        return StatedSurface{Cylinder{frame_about(axis, axis.origin), radius_mm}, rise > 0};
    }
    // How far the line passes from the axis.
    const double apart_mm = std::abs(offset.x() * flat.y() - offset.y() * flat.x()) / lean;
    if (apart_mm > resolution_mm) return std::nullopt;
    const double to_apex = -offset.head<2>().dot(flat) / (lean * lean);
    const Point3 apex = axis.origin + (offset.z() + to_apex * rise) * axis.z;
    return StatedSurface{Cone{frame_about(axis, apex), 0, std::atan2(lean, std::abs(rise))},
                         rise > 0};
}

// A circle in a plane with the axis. `hint`: a point of the part that is meant.
std::optional<StatedSurface> turned_circle(const Circle& circle, const Frame& axis,
                                           const std::optional<Point3>& hint) {
    if (!is_coplanar(circle, axis)) return std::nullopt;
    const Point3 centre = axis.to_local(circle.frame.origin);
    const double major_mm = centre.head<2>().norm();
    const Point3 on_axis = axis.origin + centre.z() * axis.z;
    // Where the circle is farthest from the axis, to the side of its centre or, for a sphere, of the hint.
    Vector3 away = circle.frame.origin - on_axis;
    if (major_mm <= resolution_mm) {
        away = axis.z.cross(circle.frame.z);
        if (hint && away.dot(*hint - on_axis) < 0) away = -away;
    }
    away.normalize();
    const Point3 farthest = circle.frame.origin + circle.radius_mm * away;
    const Curve curve = circle;
    const Vector3 along = derivative(curve, invert(curve, farthest));
    const bool same_sense = axis.z.cross(away).cross(along).dot(away) > 0;
    Frame frame = frame_about(axis, on_axis);
    if (major_mm <= resolution_mm)
        return StatedSurface{Sphere{frame, circle.radius_mm}, same_sense};
    return StatedSurface{Torus{frame, major_mm, circle.radius_mm}, same_sense};
}

Result<StatedSurface> spline_revolution(const File& file, InstanceIndex instance,
                                        const Curve& curve, const Frame& axis,
                                        const std::vector<Point3>& points,
                                        const std::optional<Point3>& hint) {
    const std::optional<Stretch> stretch = turned_stretch(curve, axis, points, hint);
    if (!stretch) {
        return unsupported(file, instance, "the surface of a curve without ends, skew to the axis");
    }
    return stated(revolved(rational(curve, stretch->low, stretch->high), axis));
}

}  // namespace

Result<StatedExtrusion> read_stated_extrusion(const File& file, InstanceIndex instance,
                                              const Units& units) {
    // name, swept_curve, extrusion_axis
    Fields fields(file, instance, 3);
    const InstanceIndex swept = fields.reference(1), vector = fields.reference(2);
    if (!fields.ok()) return fields.error();
    if (keyword(file, vector) != "VECTOR") return unexpected(file, instance, "VECTOR", vector);
    Fields vector_fields(file, vector, 3);
    const InstanceIndex orientation = vector_fields.reference(1);
    const double magnitude = vector_fields.real(2);
    if (!vector_fields.ok()) return vector_fields.error();
    const Result<Vector3> direction = read_direction(file, vector, orientation, units);
    if (!direction) return direction.error();
    return StatedExtrusion{swept, magnitude < 0 ? Vector3(-*direction) : *direction,
                           std::abs(magnitude) * units.length_mm};
}

Result<StatedRevolution> read_stated_revolution(const File& file, InstanceIndex instance,
                                                const Units& units) {
    // name, swept_curve, axis_position
    Fields fields(file, instance, 3);
    const InstanceIndex swept = fields.reference(1), position = fields.reference(2);
    if (!fields.ok()) return fields.error();
    const Result<Frame> axis = read_axis(file, instance, position, units);
    if (!axis) return axis.error();
    return StatedRevolution{swept, *axis};
}

Result<StatedSurface> read_extrusion(const File& file, InstanceIndex instance, const Units& units,
                                     const Boundary& boundary, part21::Trail& trail) {
    const Result<StatedExtrusion> extrusion = read_stated_extrusion(file, instance, units);
    if (!extrusion) return extrusion.error();
    const Vector3& direction = extrusion->direction;
    const Result<DirectedCurve> directed =
        read_curve(file, instance, extrusion->swept, units, trail);
    if (!directed) return directed.error();
    const Curve curve = simplified(directed->curve);
    const auto* line = std::get_if<Line>(&curve);
    if (line && line->direction.cross(direction).norm() <= angular_resolution_rad)
        return degenerate(file, instance);
    std::optional<StatedSurface> surface = elementary_extrusion(curve, direction);
    if (!surface) {
        const std::vector<Point3> points = boundary();
        if (points.empty()) return degenerate(file, instance);
        surface = spline_extrusion(curve, direction, points);
    }
    if (!directed->same_sense) surface->same_sense = !surface->same_sense;
    return *surface;
}

Result<StatedSurface> read_revolution(const File& file, InstanceIndex instance, const Units& units,
                                      const Boundary& boundary, part21::Trail& trail) {
    const Result<StatedRevolution> revolution = read_stated_revolution(file, instance, units);
    if (!revolution) return revolution.error();
    const auto& [swept, axis] = *revolution;
    const Result<DirectedCurve> directed = read_curve(file, instance, swept, units, trail);
    if (!directed) return directed.error();
    std::optional<Point3> hint;
    if (keyword(file, swept) == "TRIMMED_CURVE") {
        const Result<BoundedCurve> trimmed =
            read_bounded_curve(file, instance, swept, units, trail);
        if (!trimmed) return trimmed.error();
        hint = evaluate(trimmed->curve, 0.5 * (trimmed->from + trimmed->to));
    }
    const Curve curve = simplified(directed->curve);
    std::optional<StatedSurface> surface;
    if (const auto* line = std::get_if<Line>(&curve)) {
        surface = turned_line(*line, axis);
        const bool is_axis = line->direction.cross(axis.z).norm() <= angular_resolution_rad;
        if (!surface && is_axis) return degenerate(file, instance);
    } else if (const auto* circle = std::get_if<Circle>(&curve)) {
        surface = turned_circle(*circle, axis, hint);
    }
    if (!surface) {
        const Result<StatedSurface> spline =
            spline_revolution(file, instance, curve, axis, boundary(), hint);
        if (!spline) return spline.error();
        surface = *spline;
    }
    if (!directed->same_sense) surface->same_sense = !surface->same_sense;
    return *surface;
}

}  // namespace lyr::importer
