// Closed forms, surface by surface. Directions follow from one identity: for a surface P(u, v) with outward
// normal along P_u x P_v, the section runs along z x n when (du, dv) is along (dP_v/dz, -dP_u/dz).

#include "kernel/section/surface_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"

namespace lyr {
namespace {

Point2 flat(const Vector3& v) {
    return v.head<2>();
}

double lean_of(const Vector3& axis) {
    return std::hypot(axis.x(), axis.y());
}

SurfaceSection section_of_plane(const Plane& plane, bool same_sense) {
    const Vector3 outward = same_sense ? plane.frame.z : Vector3(-plane.frame.z);
    const double lean = lean_of(outward);
    if (lean <= angular_resolution_rad) return TouchSection{};
    return LineSection{left_of(flat(outward)) / lean};
}

SurfaceSection one_circle(const Point2& centre, double radius_mm, bool counter_clockwise) {
    return CircleSection{centre, 1, {radius_mm, 0}, {counter_clockwise, false}, 0};
}

SurfaceSection section_of_cylinder(const Cylinder& cylinder, bool same_sense, double z_mm,
                                   double extent_mm) {
    const Vector3 axis = cylinder.frame.z.z() < 0 ? Vector3(-cylinder.frame.z) : cylinder.frame.z;
    const Point3& origin = cylinder.frame.origin;
    const double lean = lean_of(axis), rise = axis.z(), radius = cylinder.radius_mm;
    const double sense = same_sense ? 1 : -1;
    if (rise * extent_mm <= resolution_mm) {
        return GeneratorSection{flat(origin), flat(axis) / lean, sense};
    }
    const Point2 centre = flat(origin) + (z_mm - origin.z()) / rise * flat(axis);
    if (lean * extent_mm <= resolution_mm) return one_circle(centre, radius, same_sense);
    const LeaningBasis basis = leaning_basis(axis);
    return EllipseSection{
        centre, flat(axis) / lean, flat(basis.side), radius / rise, radius, origin, basis.across,
        sense};
}

SurfaceSection section_of_cone(const Cone& cone, bool same_sense, double z_mm, double extent_mm) {
    const double sine = std::sin(cone.half_angle_rad), cosine = std::cos(cone.half_angle_rad);
    const Vector3& axis = cone.frame.z;
    const Point3 apex = cone.frame.origin - cone.radius_mm * cosine / sine * axis;
    const double height = z_mm - apex.z(), sense = same_sense ? 1 : -1;
    const double lean = lean_of(axis);
    if (lean * extent_mm <= resolution_mm) {
        const double along = std::max(0.0, height * axis.z());
        return one_circle(flat(apex), along * sine / cosine, same_sense);
    }
    // A generator rises by cosine * rise - sine * lean * cos(u); the section is closed if all rise or all fall.
    const double least = std::abs(cosine * axis.z()) - sine * lean;
    const double middle = height > 0 ? std::numbers::pi : 0;
    return ConeSection{
        apex, leaning_basis(axis), cosine, sine, height, least > angular_resolution_rad, middle,
        sense};
}

SurfaceSection section_of_sphere(const Sphere& sphere, bool same_sense, double z_mm) {
    const double height = z_mm - sphere.frame.origin.z();
    const double radius2 = (sphere.radius_mm - height) * (sphere.radius_mm + height);
    return one_circle(flat(sphere.frame.origin), std::sqrt(std::max(0.0, radius2)), same_sense);
}

// Locating a point: which component, and where along it.

Place locate(const LineSection& line, const CrossingPoint& crossing) {
    return {0, line.direction.dot(flat(crossing.point))};
}

Place locate(const GeneratorSection& lines, const CrossingPoint& crossing) {
    const bool left = cross(lines.axis, flat(crossing.on_piece) - lines.origin) > 0;
    const double along = lines.axis.dot(flat(crossing.point) - lines.origin);
    return {left ? 0 : 1, (left ? -1 : 1) * lines.sense * along};
}

Place locate(const CircleSection& circles, const CrossingPoint& crossing) {
    const double out = (flat(crossing.on_piece) - circles.centre).norm();
    const std::size_t component = circles.count == 2 && out < circles.border_mm ? 1 : 0;
    const Vector2 offset = flat(crossing.point) - circles.centre;
    const double angle = std::atan2(offset.y(), offset.x());
    return {static_cast<int>(component), circles.counter_clockwise[component] ? angle : -angle};
}

Place locate(const EllipseSection& ellipse, const CrossingPoint& crossing) {
    const Vector3 offset = crossing.point - ellipse.on_axis;
    const double angle = std::atan2(flat(offset).dot(ellipse.minor), offset.dot(ellipse.across));
    return {0, ellipse.sense * angle};
}

double cone_angle(const ConeSection& cone, double key) {
    return cone.middle_rad + cone.sense * (cone.height_mm < 0 ? -key : key);
}

Place locate(const ConeSection& cone, const CrossingPoint& crossing) {
    const Vector3 offset = crossing.point - cone.apex;
    const double angle = std::atan2(offset.dot(cone.basis.side), offset.dot(cone.basis.across));
    const double from_middle = std::remainder(angle - cone.middle_rad, full_turn_rad);
    return {0, cone.sense * (cone.height_mm < 0 ? -from_middle : from_middle)};
}

Place locate(const TouchSection&, const CrossingPoint&) {
    return {};
}

// Evaluating.

CurvePoint at(const LineSection& line, const Place& place) {
    return {place.key * line.direction, line.direction};
}

CurvePoint at(const GeneratorSection& lines, const Place& place) {
    const Vector2 direction = (place.component == 0 ? -1 : 1) * lines.sense * lines.axis;
    return {lines.origin + place.key * direction, direction};
}

CurvePoint at(const CircleSection& circles, const Place& place) {
    const auto i = static_cast<std::size_t>(place.component);
    const double turn = circles.counter_clockwise[i] ? 1 : -1, angle = turn * place.key;
    const Vector2 radial(std::cos(angle), std::sin(angle));
    return {circles.centre + circles.radius_mm[i] * radial, turn * left_of(radial)};
}

CurvePoint at(const EllipseSection& ellipse, const Place& place) {
    const double angle = ellipse.sense * place.key, c = std::cos(angle), s = std::sin(angle);
    const Vector2 a = ellipse.semi_major_mm * ellipse.major,
                  b = ellipse.semi_minor_mm * ellipse.minor;
    return {ellipse.centre + c * a + s * b, ellipse.sense * (c * b - s * a).normalized()};
}

// How far the generator rises, with cos(u) about the middle so that it does not cancel near it.
double generator_rise(const ConeSection& cone, double cos_u) {
    return cone.cosine * cone.basis.rise - cone.sine * cone.basis.lean * cos_u;
}

CurvePoint at(const ConeSection& cone, const Place& place) {
    const double u = cone_angle(cone, place.key), c = std::cos(u), s = std::sin(u);
    const LeaningBasis& basis = cone.basis;
    const Vector3 radial = c * basis.across + s * basis.side;
    const Vector3 generator = cone.cosine * basis.axis + cone.sine * radial;
    const double rise = generator_rise(cone, c);
    const Vector3 outward = cone.sense * (cone.cosine * radial - cone.sine * basis.axis);
    return {flat(cone.apex) + cone.height_mm / rise * flat(generator),
            left_of(flat(outward)).normalized()};
}

CurvePoint at(const TouchSection&, const Place&) {
    return {Point2::Zero(), Vector2::UnitX()};
}

double period_of(const LineSection&) {
    return 0;
}
double period_of(const GeneratorSection&) {
    return 0;
}
double period_of(const CircleSection&) {
    return full_turn_rad;
}
double period_of(const EllipseSection&) {
    return full_turn_rad;
}
double period_of(const ConeSection& cone) {
    return cone.closed ? full_turn_rad : 0;
}
double period_of(const TorusSection&) {
    return full_turn_rad;
}
double period_of(const FreeformSection&) {
    return 0;
}
double period_of(const TouchSection&) {
    return 0;
}

// The component's curve, moved so that it passes through the span's own ends.
PlaneCurve between(const SurfaceSection& section, int component, double from, double to,
                   const Point2& start, const Point2& end) {
    const Vector2 off_start = start - at(section, {component, from}).point;
    const Vector2 off_end = end - at(section, {component, to}).point;
    return [&section, component, from, to, off_start, off_end](double key) {
        CurvePoint there = at(section, {component, key});
        const double share = (key - from) / (to - from);
        there.point += (1 - share) * off_start + share * off_end;
        return there;
    };
}

// How far an end lies off the component, if that is so far that the span, moved to meet it, would keep nothing of its shape;
// else 0.
double distance_astray(const SurfaceSection& section, int component, double from, double to,
                       const Point2& start, const Point2& end) {
    constexpr double most_share = 0.25;
    const Point2 first = at(section, {component, from}).point;
    const Point2 middle = at(section, {component, (from + to) / 2}).point;
    const Point2 last = at(section, {component, to}).point;
    const double reach_mm = std::max((middle - first).norm(), (last - first).norm());
    const double off_mm = std::max((start - first).norm(), (end - last).norm());
    return off_mm > most_share * reach_mm ? off_mm : 0;
}

// In two arcs where one would have a chord too short to say which circle it is of.
void trace_circle(const SurfaceSection& section, int component, double from, double to, int turn,
                  const Point2& start, const Point2& end, std::vector<Segment>& out) {
    const double sweep = turn * (to - from);
    if (to - from <= 1.5 * std::numbers::pi) {
        out.push_back(arc_with_sweep(start, end, sweep));
        return;
    }
    const Point2 middle = at(section, {component, (from + to) / 2}).point;
    out.push_back(arc_with_sweep(start, middle, sweep / 2));
    out.push_back(arc_with_sweep(middle, end, sweep / 2));
}

}  // namespace

LeaningBasis leaning_basis(const Vector3& axis) {
    LeaningBasis basis{axis, {}, {}, lean_of(axis), axis.z()};
    const Vector2 level = flat(axis) / basis.lean;
    basis.side = Vector3(-level.y(), level.x(), 0);
    basis.across = Vector3(level.x() * basis.rise, level.y() * basis.rise, -basis.lean);
    return basis;
}

SurfaceSection section_of(const Surface& surface, bool same_sense, double z_mm, double extent_mm) {
    struct Visitor {
        bool same_sense;
        double z_mm, extent_mm;
        SurfaceSection operator()(const Plane& s) const { return section_of_plane(s, same_sense); }
        SurfaceSection operator()(const Cylinder& s) const {
            return section_of_cylinder(s, same_sense, z_mm, extent_mm);
        }
        SurfaceSection operator()(const Cone& s) const {
            return section_of_cone(s, same_sense, z_mm, extent_mm);
        }
        SurfaceSection operator()(const Sphere& s) const {
            return section_of_sphere(s, same_sense, z_mm);
        }
        SurfaceSection operator()(const Torus& s) const {
            return torus_section(s, same_sense, z_mm, extent_mm);
        }
        SurfaceSection operator()(const SharedBSplineSurface&) const { return TouchSection{}; }
    };
    return std::visit(Visitor{same_sense, z_mm, extent_mm}, surface);
}

Place locate(const SurfaceSection& section, const CrossingPoint& crossing) {
    return std::visit([&](const auto& s) { return locate(s, crossing); }, section);
}

int component_count(const SurfaceSection& section) {
    if (const auto* circles = std::get_if<CircleSection>(&section)) return circles->count;
    if (const auto* torus = std::get_if<TorusSection>(&section)) return torus->count;
    if (const auto* freeform = std::get_if<FreeformSection>(&section)) {
        return static_cast<int>(freeform->curves.size());
    }
    return std::holds_alternative<GeneratorSection>(section) ? 2 : 1;
}

double period(const SurfaceSection& section, int component) {
    if (const auto* freeform = std::get_if<FreeformSection>(&section)) {
        const LevelCurve& curve = freeform->curves[static_cast<std::size_t>(component)];
        return curve.closed ? curve.length_mm() : 0;
    }
    return std::visit([](const auto& s) { return period_of(s); }, section);
}

CurvePoint at(const SurfaceSection& section, const Place& place) {
    return std::visit([&](const auto& s) { return at(s, place); }, section);
}

bool is_unbroken(const SurfaceSection& section, double from, double to) {
    const auto* cone = std::get_if<ConeSection>(&section);
    if (!cone || cone->closed) return true;
    // The generators that meet the plane lie together, about the middle.
    const auto meets = [&](double key) {
        return cone->height_mm * generator_rise(*cone, std::cos(cone_angle(*cone, key))) > 0;
    };
    return meets(from) && meets(to);
}

bool trace(const SurfaceSection& section, int component, double from, double to,
           const Point2& start, const Point2& end, const Tolerance& tolerance,
           std::vector<Segment>& out) {
    if (const auto* cone = std::get_if<ConeSection>(&section)) {
        if (std::abs(cone->height_mm) <= resolution_mm) {
            out.push_back({flat(cone->apex)});
            out.push_back({end});
            return true;
        }
    }
    const auto* circles = std::get_if<CircleSection>(&section);
    const bool straight = std::holds_alternative<LineSection>(section) ||
                          std::holds_alternative<GeneratorSection>(section) ||
                          std::holds_alternative<TouchSection>(section);
    if (straight || (!circles && !(to > from))) {
        out.push_back({end});
        return true;
    }
    if (const double off_mm = distance_astray(section, component, from, to, start, end);
        off_mm > 0) {
        out.push_back({end});
        return off_mm <= tolerance.trace_mm();
    }
    if (circles) {
        const bool left = circles->counter_clockwise[static_cast<std::size_t>(component)];
        trace_circle(section, component, from, to, left ? 1 : -1, start, end, out);
        return true;
    }
    if (const auto* freeform = std::get_if<FreeformSection>(&section)) {
        trace(*freeform, component, from, to, start, end, tolerance.fit_mm(), out);
        return true;
    }
    fit_arcs(between(section, component, from, to, start, end), from, to, start, end,
             tolerance.fit_mm(), out);
    return true;
}

Contour whole_component(const SurfaceSection& section, int component, const Tolerance& tolerance) {
    if (const auto* circles = std::get_if<CircleSection>(&section)) {
        const auto i = static_cast<std::size_t>(component);
        return FullCircle{circles->centre, circles->radius_mm[i], circles->counter_clockwise[i]};
    }
    const double turn = period(section, component);
    const Point2 start = at(section, {component, 0}).point;
    Path path{start, {}};
    trace(section, component, 0, turn, start, start, tolerance, path.segments);
    return path;
}

}  // namespace lyr
