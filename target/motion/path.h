// The two paths a machine follows: a straight line and a circular arc in the plane (with an optional rise,
// a helix), each carrying the extruder along in proportion to the distance travelled.
//
// An arc is kept as its exact ends, its heading at the start and its signed curvature, not as a centre and
// angles: an arc that is almost straight then loses no digits, and no end drifts off its neighbour's start.
//
// Contract
//  1. position_at(p, 0) is the start and position_at(p, length_mm(p)) the end, bit for bit.
//  2. length_mm is the length in (x, y, z); where nothing moves but the extruder it is |e's change|.
//     Extruder and rise are linear in the distance.
//  3. arc_by_sagitta: positive sagitta turns counter-clockwise. For a chord c and sagitta h with
//     c > 0 and h from 0 (a straight line) to c * kLargestSagittaRatio, heading and curvature are right to
//     kArcRelativeError. The longer way round has |h| > c / 2.
//  4. full_circle and arc_by_centre start at `start`; the radius is the distance to the centre. A full circle
//     ends where it starts.
//  5. Coordinates that are not finite, or beyond kLargestCoordinate_mm, are refused with a Diagnostic.

#pragma once

#include <array>
#include <variant>

#include "base/diagnostic.h"

namespace lyr::motion {

// Four products and a quotient of exact inputs.
inline constexpr double kArcRelativeError = 8 * 2.3e-16;
// Beyond this the chord's direction carries the heading's error over into the far side of the circle.
inline constexpr double kLargestSagittaRatio = 1e9;
// A kilometre of machine, 1000 km of filament: positions still resolve far below a picometre-step.
inline constexpr double kLargestCoordinate_mm = 1e9;

struct Position {
    double x_mm = 0, y_mm = 0, z_mm = 0, e_mm = 0;
    bool operator==(const Position&) const = default;
};

struct Line {
    Position start, end;
};

struct Arc {
    Position start, end;
    double heading_x, heading_y;  // unit tangent of the plane projection at the start
    double curvature_per_mm;      // of the plane projection; positive: counter-clockwise
    double sweep_rad;             // signed like the curvature; at most a full turn
};

using Path = std::variant<Line, Arc>;

Result<Path> line(const Position& start, const Position& end);

// Start and end may differ in z and e too. A zero sagitta gives a line.
Result<Path> arc_by_sagitta(const Position& start, const Position& end, double sagitta_mm);

// `end_z_mm` and `end_e_mm` as in a helix; `sweep_rad` signed, |sweep| <= 2 pi.
Result<Path> arc_by_centre(const Position& start, double centre_x_mm, double centre_y_mm,
                           double sweep_rad, double end_z_mm, double end_e_mm);
Result<Path> full_circle(const Position& start, double centre_x_mm, double centre_y_mm,
                         bool counter_clockwise, double end_z_mm, double end_e_mm);

const Position& start_of(const Path& path);
const Position& end_of(const Path& path);
double length_mm(const Path& path);
Position position_at(const Path& path, double distance_mm);

// How each coordinate changes by millimetre travelled: (x, y, z) is a unit vector, or zero where only the
// extruder moves; e is its rate.
using Rates = std::array<double, 4>;
Rates rates_at_start(const Path& path);
Rates rates_at_end(const Path& path);

// Of the arc's plane projection: length, radius.
double plane_length_mm(const Arc& arc);
double radius_mm(const Arc& arc);

}  // namespace lyr::motion
