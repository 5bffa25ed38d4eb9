#include "target/motion/kinematics.h"

#include <cmath>
#include <numbers>
#include <string>

namespace lyr::motion {
namespace {

using std::numbers::pi;

MotorPath even(double from_mm, double to_mm, double length_mm, double origin_mm,
               double steps_per_mm) {
    return Linear{steps_per_mm * (from_mm - origin_mm),
                  steps_per_mm * (to_mm - from_mm) / length_mm};
}

double dot(const AxisShares& shares, const Point& point) {
    return shares[axis_x] * point.x + shares[axis_y] * point.y + shares[axis_z] * point.z;
}

// An angle that runs backwards has the same cosine as its mirror image that runs forwards; a motor
// the other way round is half a turn ahead. `size` and `ahead_rad` are of the axes' shares as a
// vector in the plane.
MotorPath turning(const Arc& arc, double size, double ahead_rad, double length_mm, double from_mm,
                  double steps_per_mm) {
    const double angle_rad = arc.start_angle_rad - ahead_rad;
    const double forwards_rad =
        (arc.sweep_rad < 0 ? -angle_rad : angle_rad) + (steps_per_mm < 0 ? pi : 0);
    const double turns = std::floor(forwards_rad / (2 * pi));
    return Harmonic{steps_per_mm * from_mm, std::abs(steps_per_mm) * size * arc.radius_mm,
                    forwards_rad - turns * 2 * pi, std::abs(arc.sweep_rad) / length_mm};
}

}  // namespace

Status check(const Kinematics& kinematics) {
    constexpr std::array names{"x", "y", "z", "e"};
    const auto& steps = steps_per_mm(kinematics);
    for (std::size_t i = 0; i < axis_count; ++i)
        if (!(std::abs(steps[i]) <= most_steps_per_mm))
            return machine_error(std::string("the steps per mm of axis ") + names[i] +
                                 " must be a number up to 1e6 in size");
    return Done{};
}

const std::array<double, axis_count>& steps_per_mm(const Kinematics& kinematics) {
    return std::visit(
        [](const auto& kind) -> const auto& { return kind.steps_per_mm; }, kinematics);
}

AxisShares axis_shares(const LinearKinematics& kinematics, std::size_t motor) {
    if (std::holds_alternative<CoreXy>(kinematics) && motor <= axis_y)
        return {1, motor == axis_x ? 1.0 : -1.0, 0};
    AxisShares own{};
    own[motor] = 1;
    return own;
}

double carriage_mm(const Delta::Tower& tower, const Point& head) {
    const double off_mm = std::hypot(head.x - tower.x_mm, head.y - tower.y_mm);
    return head.z + std::sqrt((tower.arm_mm - off_mm) * (tower.arm_mm + off_mm));
}

namespace {

Point minus(const Point& a, const Point& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

double dot(const Point& a, const Point& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Point sum(const Point& from, double a, const Point& u, double b, const Point& v) {
    return {from.x + a * u.x + b * v.x, from.y + a * u.y + b * v.y, from.z + a * u.z + b * v.z};
}

// Where three spheres about the carriages meet: in the plane of their centres, the point of equal power to all
// three, and from there down at a right angle.
Point head_at(const Delta& delta, const std::array<double, 3>& motors_mm) {
    std::array<Point, 3> joint;
    for (std::size_t i = 0; i < joint.size(); ++i)
        joint[i] = {delta.towers[i].x_mm, delta.towers[i].y_mm, motors_mm[i]};
    const Point u = minus(joint[1], joint[0]), v = minus(joint[2], joint[0]);
    const double r0 = delta.towers[0].arm_mm * delta.towers[0].arm_mm;
    const auto power = [&](std::size_t i, const Point& way) {
        return (r0 - delta.towers[i].arm_mm * delta.towers[i].arm_mm + dot(way, way)) / 2;
    };
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const double pu = power(1, u), pv = power(2, v);
    const double size = uu * vv - uv * uv;
    const double a = (pu * vv - pv * uv) / size, b = (pv * uu - pu * uv) / size;
    const Point foot = sum(joint[0], a, u, b, v);
    const Point way = minus(foot, joint[0]);
    const Point normal = cross(u, v);
    const double down = (normal.z > 0 ? -1 : 1) * std::sqrt((r0 - dot(way, way)) / size);
    return sum(foot, down, normal, 0, normal);
}

}  // namespace

std::array<double, 3> motors_at(const Kinematics& kinematics, const Point& head) {
    if (std::holds_alternative<CoreXy>(kinematics))
        return {head.x + head.y, head.x - head.y, head.z};
    std::array<double, 3> motors_mm{head.x, head.y, head.z};
    if (const auto* delta = std::get_if<Delta>(&kinematics))
        for (std::size_t i = 0; i < motors_mm.size(); ++i)
            motors_mm[i] = carriage_mm(delta->towers[i], head);
    return motors_mm;
}

Point head_at(const Kinematics& kinematics, const std::array<double, 3>& motors_mm) {
    const auto& [a, b, c] = motors_mm;
    if (std::holds_alternative<CoreXy>(kinematics)) return {(a + b) / 2, (a - b) / 2, c};
    if (const auto* delta = std::get_if<Delta>(&kinematics)) return head_at(*delta, motors_mm);
    return {a, b, c};
}

MotorPaths motor_paths(const LinearKinematics& kinematics, const Path& path, const Point& origin) {
    const auto& steps = std::visit(
        [](const auto& kind) -> const auto& { return kind.steps_per_mm; }, kinematics);
    const double length_mm = length_of(path);
    const auto* arc = std::get_if<Arc>(&path);
    MotorPaths motors;
    for (std::size_t motor = 0; motor < extruder_motor; ++motor) {
        const AxisShares shares = axis_shares(kinematics, motor);
        const double from_mm = dot(shares, start_of(path)), to_mm = dot(shares, end_of(path));
        const double origin_mm = dot(shares, origin);
        const double size = std::hypot(shares[axis_x], shares[axis_y]);
        if (arc && size != 0 && steps[motor] != 0)
            motors[motor] = turning(*arc, size, std::atan2(shares[axis_y], shares[axis_x]),
                                    length_mm, from_mm - origin_mm, steps[motor]);
        else
            motors[motor] = even(from_mm, to_mm, length_mm, origin_mm, steps[motor]);
    }
    motors[extruder_motor] = even(0, advance_of(path), length_mm, 0, steps[axis_e]);
    return motors;
}

}  // namespace lyr::motion
