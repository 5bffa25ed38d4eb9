// What the head is asked to follow: straight pieces and circular arcs in x and y, each with z and
// the extruder moving evenly along. An arc stays an arc down to the motors; nothing here makes
// chords.
//
// Method. An arc is walked as a chord from its start: after the angle phi the head is 2 r sin(phi /
// 2) away, in the direction of the start's tangent turned by phi / 2. No difference of large
// numbers occurs, so an arc whose radius is a thousand kilometres is as exact as a small one.
//
// Contract
//  1. point_at(path, 0) is `from`, point_at(path, length) is `to` up to rounding (a few ulps of the
//     coordinates), for every radius.
//  2. arc_through() takes the sagitta as the signed height of the arc's middle over the chord:
//     positive is counter-clockwise, more than the radius is an arc of more than half a turn. Its
//     sweep is 4 atan(2 sagitta / chord) to a few ulps, from 0 up to, not including, a full turn.
//  3. The length is that in space (a helix counts z), or of the extruder alone where nothing else
//     moves.
//  4. tangent_at() has length 1 in x, y and z, or is 0 where only the extruder moves.

#pragma once

#include <array>
#include <cstddef>
#include <variant>

namespace lyr::motion {

// Of everything that is listed by axis; the extruder comes last.
enum Axis : std::size_t { axis_x = 0, axis_y = 1, axis_z = 2, axis_e = 3 };
inline constexpr std::size_t axis_count = 4;

struct Point {
    double x = 0, y = 0, z = 0;  // mm
    friend bool operator==(const Point&, const Point&) = default;
};

struct Line {
    Point from, to;
    double advance_mm = 0;  // of the filament; negative: drawn back
};

struct Arc {
    Point from, to;
    double advance_mm = 0;
    double center_x_mm = 0, center_y_mm = 0, radius_mm = 0;
    double start_angle_rad = 0;
    double sweep_rad = 0;  // counter-clockwise positive; at most one turn
};

using Path = std::variant<Line, Arc>;

// The arc from `from` to `to` with this sagitta. It is the line where the ends are the same in x
// and y, or the arc's middle is off the chord by less than rounding.
Path arc_through(const Point& from, const Point& to, double sagitta_mm, double advance_mm);

// One whole turn from `from` about the centre; `to_z_mm` is where it ends.
Path circle_about(const Point& from, double center_x_mm, double center_y_mm, bool counter_clockwise,
                  double to_z_mm, double advance_mm);

// From a centre, a radius, and angles; sweeps of more than a turn are the caller's to split.
Path arc_about(double center_x_mm, double center_y_mm, double radius_mm, double start_angle_rad,
               double sweep_rad, double from_z_mm, double to_z_mm, double advance_mm);

const Point& start_of(const Path& path);
const Point& end_of(const Path& path);
double advance_of(const Path& path);

// Contract 3.
double length_of(const Path& path);
Point point_at(const Path& path, double distance_mm);
// For who knows the length already.
Point point_at_share(const Path& path, double share);
// The direction of motion; contract 4.
Point tangent_at(const Path& path, double distance_mm);

}  // namespace lyr::motion
