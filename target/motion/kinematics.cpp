#include "target/motion/kinematics.h"

#include <cmath>
#include <numbers>
#include <string>

namespace lyr::motion {
namespace {

constexpr double pi = std::numbers::pi;

double along(const Point& point, std::size_t axis) {
    return axis == axis_x ? point.x : axis == axis_y ? point.y : point.z;
}

MotorPath even(double from_mm, double to_mm, double length_mm, double origin_mm,
               double steps_per_mm) {
    return Linear{steps_per_mm * (from_mm - origin_mm),
                  steps_per_mm * (to_mm - from_mm) / length_mm};
}

// An angle that runs backwards has the same cosine as its mirror image that runs forwards; a motor
// the other way round is half a turn ahead.
MotorPath turning(const Arc& arc, std::size_t axis, double length_mm, double origin_mm,
                  double steps_per_mm) {
    const double angle_rad = arc.start_angle_rad - (axis == axis_y ? pi / 2 : 0);
    const double forwards_rad =
        (arc.sweep_rad < 0 ? -angle_rad : angle_rad) + (steps_per_mm < 0 ? pi : 0);
    const double turns = std::floor(forwards_rad / (2 * pi));
    return Harmonic{steps_per_mm * (along(arc.from, axis) - origin_mm),
                    std::abs(steps_per_mm) * arc.radius_mm, forwards_rad - turns * 2 * pi,
                    std::abs(arc.sweep_rad) / length_mm};
}

MotorPaths paths(const Cartesian& cartesian, const Path& path, const Point& origin) {
    const double length_mm = length_of(path);
    const Point &from = start_of(path), &to = end_of(path);
    const auto* arc = std::get_if<Arc>(&path);
    MotorPaths motors;
    for (std::size_t axis = axis_x; axis <= axis_z; ++axis) {
        const double origin_mm = along(origin, axis), steps_per_mm = cartesian.steps_per_mm[axis];
        const bool turns = arc && axis != axis_z && steps_per_mm != 0;
        motors[axis] =
            turns ? turning(*arc, axis, length_mm, origin_mm, steps_per_mm)
                  : even(along(from, axis), along(to, axis), length_mm, origin_mm, steps_per_mm);
    }
    motors[axis_e] = even(0, advance_of(path), length_mm, 0, cartesian.steps_per_mm[axis_e]);
    return motors;
}

}  // namespace

Status check(const Kinematics& kinematics) {
    constexpr std::array names{"x", "y", "z", "e"};
    const auto& steps_per_mm = std::get<Cartesian>(kinematics).steps_per_mm;
    for (std::size_t i = 0; i < axis_count; ++i)
        if (!(std::abs(steps_per_mm[i]) <= most_steps_per_mm))
            return Diagnostic{Severity::error,
                              ExitStatus::machine,
                              std::string("the steps per mm of axis ") + names[i] +
                                  " must be a number up to 1e6 in size",
                              {}};
    return Done{};
}

MotorPaths motor_paths(const Kinematics& kinematics, const Path& path, const Point& origin) {
    return std::visit([&](const auto& kind) { return paths(kind, path, origin); }, kinematics);
}

}  // namespace lyr::motion
