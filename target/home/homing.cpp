#include "target/home/homing.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "target/home/delta_fit.h"
#include "target/home/probing.h"
#include "target/moves/machine.h"

namespace lyr::home {
namespace {

using config::axis_x, config::axis_y, config::axis_z;

bool is_delta(const config::Printer& printer) {
    return printer.kinematics == config::Kinematics::delta;
}

double endstop_mm(const config::Printer& printer, std::size_t axis) {
    const config::Endstop& endstop = printer.endstops[axis];
    if (is_delta(printer)) return carriage_endstop_mm(printer, axis);
    const config::Axis& limits = printer.axes[axis];
    return endstop.at_mm.value_or(endstop.at_high_end ? limits.max_mm : limits.min_mm);
}

// From the other end of the axis to its endstop; of a carriage from its lowest place, with the head on the bed and
// farthest from it.
double length_mm(const config::Printer& printer, std::size_t axis) {
    if (!is_delta(printer))
        return printer.endstops[axis].at_high_end
                   ? endstop_mm(printer, axis) - printer.axes[axis].min_mm
                   : printer.axes[axis].max_mm - endstop_mm(printer, axis);
    const config::DeltaFrame& frame = printer.delta;
    const double off_mm = frame.radius_mm[axis] + frame.reach_mm;
    const double arm_mm = frame.arm_mm[axis];
    const double lowest_mm = std::sqrt(std::max(0.0, (arm_mm - off_mm) * (arm_mm + off_mm)));
    return endstop_mm(printer, axis) - printer.axes[axis_z].min_mm - lowest_mm;
}

bool z_by_probe(const config::Printer& printer) {
    return !is_delta(printer) && !printer.endstops[axis_z].input && printer.probe &&
           printer.probe->input;
}

Target target_of(const config::Printer& printer, std::size_t axis) {
    const double reach_mm = length_mm(printer, axis) + printer.homing.margin_mm;
    if (axis == axis_z && z_by_probe(printer)) {
        const config::Probe& probe = *printer.probe;
        return {axis,
                config::contact_probe,
                -1,
                reach_mm,
                probe.offset_mm[2],
                probe.fast_mm_s,
                probe.slow_mm_s,
                probe.lift_mm,
                printer.homing.tolerance_mm};
    }
    const config::Endstop& endstop = printer.endstops[axis];
    const bool high = endstop.at_high_end || is_delta(printer);
    // Where the axis comes from below, its motor is ahead by the play.
    const double at_mm = endstop_mm(printer, axis) + (high ? printer.backlash_mm[axis] : 0);
    return {axis,
            axis,
            high ? 1 : -1,
            reach_mm,
            at_mm,
            endstop.fast_mm_s,
            endstop.slow_mm_s,
            endstop.back_off_mm,
            printer.homing.tolerance_mm};
}

// The towers of a delta are three axes, each with the speed of z.
config::Printer machine_by_axes(const config::Printer& printer) {
    config::Printer machine = bare_machine(printer);
    if (!is_delta(printer)) return machine;
    machine.kinematics = config::Kinematics::cartesian;
    machine.shapers = {};
    for (const std::size_t axis : {axis_x, axis_y}) {
        machine.axes[axis].max_speed_mm_s = printer.axes[axis_z].max_speed_mm_s;
        machine.axes[axis].max_acceleration_mm_s2 = printer.axes[axis_z].max_acceleration_mm_s2;
    }
    return machine;
}

// With z by the probe x and y come first, whatever the order says.
std::vector<std::size_t> order_of(const config::Printer& printer, AxisSet axes) {
    std::vector<std::size_t> order;
    for (const std::size_t axis : printer.homing.order)
        if (axes[axis] && !(axis == axis_z && z_by_probe(printer))) order.push_back(axis);
    if (axes[axis_z] && z_by_probe(printer)) order.push_back(axis_z);
    return order;
}

Status lift(Mover& mover, ByAxes& machine, const config::Printer& printer,
            const std::vector<std::size_t>& order) {
    const bool z_up = printer.endstops[axis_z].input && printer.endstops[axis_z].at_high_end;
    if (printer.homing.lift_mm == 0 || (z_up && order.front() == axis_z)) return Done{};
    const Result<Contacts> touched = mover.touched();
    if (!touched) return touched.error();
    // One that is touched already triggers no more: the axis is as high as it can be.
    if (z_up && (*touched)[axis_z]) return Done{};
    Contacts watched;
    watched[axis_z] = z_up;
    const Result<Moved> moved =
        machine.move({0, 0, printer.homing.lift_mm}, printer.axes[axis_z].max_speed_mm_s, watched);
    return moved ? Status(Done{}) : moved.error();
}

// Over the place where the probe homes z.
Status go_to_probe(ByAxes& machine, const config::Printer& printer) {
    const std::array<double, 3>& offset = printer.probe->offset_mm;
    const Spot place = probe_spot(printer);
    const std::array<double, 3>& at = machine.at_mm();
    const Result<Moved> moved = machine.move(
        {place.x_mm - offset[0] - at[axis_x], place.y_mm - offset[1] - at[axis_y], 0},
        std::hypot(printer.axes[axis_x].max_speed_mm_s, printer.axes[axis_y].max_speed_mm_s));
    return moved ? Status(Done{}) : moved.error();
}

Result<double> home_by_axes(Mover& mover, ByAxes& machine, const config::Printer& printer,
                            const std::vector<std::size_t>& order) {
    double repeat_mm = 0;
    if (Status lifted = lift(mover, machine, printer, order); !lifted) return lifted.error();
    for (const std::size_t axis : order) {
        const Target target = target_of(printer, axis);
        if (target.contact == config::contact_probe)
            if (Status there = go_to_probe(machine, printer); !there) return there.error();
        const Result<double> found = machine.home(std::array{target});
        if (!found) return found;
        repeat_mm = std::max(repeat_mm, *found);
    }
    return repeat_mm;
}

// From where all motors come to a place downwards, with their play taken up.
std::optional<motion::Point> beyond_play(const config::Printer& printer, const motion::Point& to) {
    const motion::Kinematics kinematics = moves::kinematics_of(printer);
    std::array<double, 3> motors_mm = motion::motors_at(kinematics, to);
    bool any = false;
    for (std::size_t i = 0; i < motors_mm.size(); ++i) {
        motors_mm[i] += 2 * printer.backlash_mm[i];
        any = any || printer.backlash_mm[i] > 0;
    }
    if (!any) return std::nullopt;
    return motion::head_at(kinematics, motors_mm);
}

}  // namespace

AxisSet homable(const config::Printer& printer) {
    AxisSet axes;
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
        axes[axis] = printer.endstops[axis].input || (axis == axis_z && z_by_probe(printer));
    return axes;
}

config::Printer bare_machine(const config::Printer& printer) {
    config::Printer machine = printer;
    machine.mesh.heights_mm.clear();
    machine.backlash_mm = {};
    machine.pressure_advance_s = 0;
    return machine;
}

Result<Homed> home(Mover& mover, const config::Printer& printer, AxisSet axes) {
    const AxisSet possible = homable(printer);
    if ((axes & ~possible).any() || axes.none()) {
        std::size_t axis = 0;
        while (axis < 2 && (possible[axis] || (axes.any() && !axes[axis]))) ++axis;
        return machine_error("printer \"" + printer.name + "\" has no axis." +
                             std::string(config::axis_names[axis]) + ".endstop to home with");
    }
    if (is_delta(printer)) axes.set();
    if (axes[axis_z] && z_by_probe(printer)) axes |= possible;
    ByAxes machine(mover, machine_by_axes(printer));
    if (!is_delta(printer)) {
        const Result<double> repeat_mm =
            home_by_axes(mover, machine, printer, order_of(printer, axes));
        if (!repeat_mm) return repeat_mm.error();
        const auto& [x, y, z] = machine.at_mm();
        return Homed{{x, y, z}, *repeat_mm};
    }
    const std::array towers{target_of(printer, 0), target_of(printer, 1), target_of(printer, 2)};
    const Result<double> repeat_mm = machine.home(towers);
    if (!repeat_mm) return repeat_mm.error();
    return Homed{motion::head_at(moves::kinematics_of(printer), machine.at_mm()), *repeat_mm};
}

Status travel(Mover& mover, const config::Printer& printer, const motion::Point& from,
              const motion::Point& to) {
    config::Printer machine = bare_machine(printer);
    machine.start_mm = {from.x, from.y, from.z};
    const double high_mm = std::max(from.z, to.z);
    std::vector<motion::Point> places{from, {from.x, from.y, high_mm}, {to.x, to.y, high_mm}};
    if (const auto beyond = beyond_play(printer, to)) places.push_back(*beyond);
    places.push_back(to);
    double fastest_mm_s = 0;
    for (const config::Axis& axis : printer.axes)
        fastest_mm_s = std::hypot(fastest_mm_s, axis.max_speed_mm_s);
    std::vector<motion::Move> moves;
    for (std::size_t i = 1; i < places.size(); ++i) {
        const motion::Line line{places[i - 1], places[i]};
        if (motion::length_of(line) > motion::Planner::shortest_mm)
            moves.push_back({line, fastest_mm_s});
    }
    if (moves.empty()) return Done{};
    const Result<Moved> moved = mover.run(machine, moves);
    return moved ? Status(Done{}) : moved.error();
}

}  // namespace lyr::home
