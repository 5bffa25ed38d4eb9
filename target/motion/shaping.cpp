// The taps of all that moves a motor, with its steps and its share of each axis.

#include "target/motion/shaping.h"

namespace lyr::motion {
namespace {

// Adds the weight of one channel to the tap of that offset.
void add(Taps& taps, std::int64_t offset_ns, std::size_t channel, double weight) {
    for (Tap& tap : taps)
        if (tap.offset_ns == offset_ns) {
            tap.weights[channel] += weight;
            return;
        }
    taps.push_back({offset_ns, {}});
    taps.back().weights[channel] = weight;
}

// Those of one axis, times a factor, into the taps of a motor.
void add(Taps& taps, const Shaping& shaping, std::size_t axis, double factor) {
    if (factor == 0) return;
    if (shaping.axes[axis].empty()) add(taps, 0, axis, factor);
    for (const Tap& tap : shaping.axes[axis])
        add(taps, tap.offset_ns, axis, factor * tap.weights[axis]);
}

double coordinate(const Point& point, std::size_t axis) {
    return axis == axis_x ? point.x : axis == axis_y ? point.y : point.z;
}

MotorFunction sum_of_axes(const LinearKinematics& kinematics, std::size_t motor,
                          double steps_per_mm, const Point& origin, const Shaping& shaping) {
    const AxisShares shares = axis_shares(kinematics, motor);
    Taps taps;
    double start_steps = 0;
    for (std::size_t axis = 0; axis < shares.size(); ++axis) {
        add(taps, shaping, axis, steps_per_mm * shares[axis]);
        start_steps += steps_per_mm * shares[axis] * coordinate(origin, axis);
    }
    return MotorFunction::sum(taps, start_steps);
}

// A motor that follows x, y and z otherwise than by adding them up.
MotorFunction in_space(double steps_per_mm, const std::optional<Delta::Tower>& tower,
                       const Point& origin, const Shaping& shaping) {
    Taps taps;
    for (std::size_t axis = 0; axis < shaping.axes.size(); ++axis) add(taps, shaping, axis, 1);
    Point lifted = origin;
    if (shaping.bed) lifted.z += shaping.bed->lift_mm(origin);
    return MotorFunction::in_space(taps, tower, shaping.bed, steps_per_mm,
                                   tower ? carriage_mm(*tower, lifted) : lifted.z);
}

MotorFunction function_of(const LinearKinematics& machine, double steps_per_mm, std::size_t motor,
                          const Point& origin, const Shaping& shaping) {
    if (motor == axis_z && shaping.bed) return in_space(steps_per_mm, {}, origin, shaping);
    return sum_of_axes(machine, motor, steps_per_mm, origin, shaping);
}

MotorFunction function_of(const Delta& machine, double steps_per_mm, std::size_t motor,
                          const Point& origin, const Shaping& shaping) {
    return in_space(steps_per_mm, machine.towers[motor], origin, shaping);
}

}  // namespace

MotorFunction function_of(const Kinematics& kinematics, std::size_t motor, const Point& origin,
                          const Shaping& shaping) {
    const double steps = steps_per_mm(kinematics)[motor];
    return std::visit(
        [&](const auto& machine) { return function_of(machine, steps, motor, origin, shaping); },
        kinematics);
}

MotorFunction extruder_of(const Kinematics& kinematics, const Shaping& shaping) {
    Taps taps;
    if (shaping.extruder.empty()) add(taps, 0, axis_e, 1);
    for (const Tap& tap : shaping.extruder)
        for (const std::size_t channel : {std::size_t{axis_e}, pressed_channel})
            if (tap.weights[channel] != 0) add(taps, tap.offset_ns, channel, tap.weights[channel]);
    for (Tap& tap : taps)
        for (double& weight : tap.weights) weight *= steps_per_mm(kinematics)[axis_e];
    return MotorFunction::sum(taps, 0);
}

}  // namespace lyr::motion
