// Arcs are walked from their start, never from their centre; see path.h.

#include "target/motion/path.h"

#include <cmath>
#include <numbers>

namespace lyr::motion {
namespace {

using std::numbers::pi;

// Of sagitta to half chord: below this the arc's middle is off the chord by less than the rounding
// of the chord itself.
constexpr double flattest = 1e-15;

double sign_of(double value) {
    return value < 0 ? -1 : 1;
}

double length_in_space_mm(const Line& line) {
    return std::hypot(line.to.x - line.from.x, line.to.y - line.from.y, line.to.z - line.from.z);
}

double length_in_space_mm(const Arc& arc) {
    return std::hypot(arc.radius_mm * std::abs(arc.sweep_rad), arc.to.z - arc.from.z);
}

Point after_turning(const Arc& arc, double angle_rad, double share) {
    const double chord_mm = 2 * arc.radius_mm * std::sin(angle_rad / 2);
    const double middle_rad = arc.start_angle_rad + angle_rad / 2;
    return {arc.from.x - chord_mm * std::sin(middle_rad),
            arc.from.y + chord_mm * std::cos(middle_rad),
            arc.from.z + share * (arc.to.z - arc.from.z)};
}

Point at_share(const Line& line, double share) {
    return {line.from.x + share * (line.to.x - line.from.x),
            line.from.y + share * (line.to.y - line.from.y),
            line.from.z + share * (line.to.z - line.from.z)};
}

Point at_share(const Arc& arc, double share) {
    return after_turning(arc, share * arc.sweep_rad, share);
}

Point tangent_at_share(const Line& line, double, double length_mm) {
    return {(line.to.x - line.from.x) / length_mm, (line.to.y - line.from.y) / length_mm,
            (line.to.z - line.from.z) / length_mm};
}

Point tangent_at_share(const Arc& arc, double share, double length_mm) {
    const double angle_rad = arc.start_angle_rad + share * arc.sweep_rad;
    const double level = arc.radius_mm * arc.sweep_rad / length_mm;
    return {-std::sin(angle_rad) * level, std::cos(angle_rad) * level,
            (arc.to.z - arc.from.z) / length_mm};
}

}  // namespace

Path arc_through(const Point& from, const Point& to, double sagitta_mm, double advance_mm) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    const double chord_mm = std::hypot(dx, dy);
    const double t = 2 * sagitta_mm / chord_mm;  // tan(sweep / 4)
    if (!(chord_mm > 0) || !(std::abs(t) > flattest)) return Line{from, to, advance_mm};
    Arc arc{from, to, advance_mm};
    arc.sweep_rad = 4 * std::atan(t);
    arc.radius_mm = chord_mm * (1 + t * t) / (4 * std::abs(t));
    // The start's tangent lies half the sweep before the chord's direction, the radius a quarter
    // turn.
    arc.start_angle_rad = std::atan2(dy, dx) - arc.sweep_rad / 2 - sign_of(t) * pi / 2;
    arc.center_x_mm = from.x - arc.radius_mm * std::cos(arc.start_angle_rad);
    arc.center_y_mm = from.y - arc.radius_mm * std::sin(arc.start_angle_rad);
    return arc;
}

Path circle_about(const Point& from, double center_x_mm, double center_y_mm, bool counter_clockwise,
                  double to_z_mm, double advance_mm) {
    const Point to{from.x, from.y, to_z_mm};
    const double dx = from.x - center_x_mm, dy = from.y - center_y_mm;
    if (dx == 0 && dy == 0) return Line{from, to, advance_mm};
    return Arc{from,
               to,
               advance_mm,
               center_x_mm,
               center_y_mm,
               std::hypot(dx, dy),
               std::atan2(dy, dx),
               counter_clockwise ? 2 * pi : -2 * pi};
}

Path arc_about(double center_x_mm, double center_y_mm, double radius_mm, double start_angle_rad,
               double sweep_rad, double from_z_mm, double to_z_mm, double advance_mm) {
    const Point from{center_x_mm + radius_mm * std::cos(start_angle_rad),
                     center_y_mm + radius_mm * std::sin(start_angle_rad), from_z_mm};
    if (radius_mm == 0 || sweep_rad == 0) return Line{from, {from.x, from.y, to_z_mm}, advance_mm};
    Arc arc{from,        {0, 0, to_z_mm}, advance_mm,      center_x_mm,
            center_y_mm, radius_mm,       start_angle_rad, sweep_rad};
    const Point to = after_turning(arc, sweep_rad, 1);
    arc.to = {to.x, to.y, to_z_mm};
    return arc;
}

const Point& start_of(const Path& path) {
    return std::visit([](const auto& shape) -> const Point& { return shape.from; }, path);
}

const Point& end_of(const Path& path) {
    return std::visit([](const auto& shape) -> const Point& { return shape.to; }, path);
}

double advance_of(const Path& path) {
    return std::visit([](const auto& shape) { return shape.advance_mm; }, path);
}

double length_of(const Path& path) {
    const double in_space_mm =
        std::visit([](const auto& shape) { return length_in_space_mm(shape); }, path);
    return in_space_mm > 0 ? in_space_mm : std::abs(advance_of(path));
}

Point point_at(const Path& path, double distance_mm) {
    const double length_mm = length_of(path);
    return point_at_share(path, length_mm > 0 ? distance_mm / length_mm : 0);
}

Point point_at_share(const Path& path, double share) {
    return std::visit([share](const auto& shape) { return at_share(shape, share); }, path);
}

Point tangent_at(const Path& path, double distance_mm) {
    const double length_mm = length_of(path);
    if (!(length_mm > 0)) return {};
    return std::visit(
        [&](const auto& shape) {
            return tangent_at_share(shape, distance_mm / length_mm, length_mm);
        },
        path);
}

}  // namespace lyr::motion
