// Each motor runs ahead on its own to its next step or to where the plan ends for it; the soonest step that
// no motor may still come before is the next event.

#include "target/motion/timed_generator.h"

#include <algorithm>

namespace lyr::motion {
namespace {

constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();

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

MotorFunction function_of(const Cartesian& machine, std::size_t motor, const Point& origin,
                          const Shaping& shaping) {
    const double steps_per_mm = machine.steps_per_mm[motor];
    if (motor == axis_z && shaping.bed) return in_space(steps_per_mm, {}, origin, shaping);
    return sum_of_axes(machine, motor, steps_per_mm, origin, shaping);
}

MotorFunction function_of(const CoreXy& machine, std::size_t motor, const Point& origin,
                          const Shaping& shaping) {
    const double steps_per_mm = machine.steps_per_mm[motor];
    if (motor == axis_z && shaping.bed) return in_space(steps_per_mm, {}, origin, shaping);
    return sum_of_axes(machine, motor, steps_per_mm, origin, shaping);
}

MotorFunction function_of(const Delta& machine, std::size_t motor, const Point& origin,
                          const Shaping& shaping) {
    return in_space(machine.steps_per_mm[motor], machine.towers[motor], origin, shaping);
}

MotorFunction extruder_of(double steps_per_mm, const Shaping& shaping) {
    Taps taps;
    if (shaping.extruder.empty()) add(taps, 0, axis_e, 1);
    for (const Tap& tap : shaping.extruder)
        for (const std::size_t channel : {std::size_t{axis_e}, pressed_channel})
            if (tap.weights[channel] != 0) add(taps, tap.offset_ns, channel, tap.weights[channel]);
    for (Tap& tap : taps)
        for (double& weight : tap.weights) weight *= steps_per_mm;
    return MotorFunction::sum(taps, 0);
}

}  // namespace

TimedGenerator::TimedGenerator(const Kinematics& kinematics, const Point& origin,
                               const Shaping& shaping) {
    for (std::size_t motor = 0; motor < extruder_motor; ++motor)
        motors_.push_back(
            {std::visit(
                 [&](const auto& machine) { return function_of(machine, motor, origin, shaping); },
                 kinematics),
             TimeWalk(shaping.play_steps[motor]),
             {}});
    motors_.push_back({extruder_of(steps_per_mm(kinematics)[axis_e], shaping), TimeWalk(), {}});
    for (const Motor& motor : motors_) {
        lead_ns_ = std::max(lead_ns_, motor.function.ahead_ns());
        behind_ns_ = std::max(behind_ns_, motor.function.behind_ns());
    }
    for (Motor& motor : motors_) motor.begin = {-lead_ns_, 0};
    next_ns_.fill(-lead_ns_);
    waits_.fill(true);
}

void TimedGenerator::start(const PlannedMove& planned) {
    std::uint64_t oldest = window_.end();
    for (const Motor& motor : motors_) oldest = std::min(oldest, motor.function.oldest_move());
    window_.drop_before(oldest);
    window_.push(planned);
    find_waiting();
}

void TimedGenerator::rest_until(std::int64_t plan_ns) {
    window_.rest_until(plan_ns);
    find_waiting();
}

void TimedGenerator::finish() {
    window_.rest_until(never_ns);
    find_waiting();
}

void TimedGenerator::find_waiting() {
    for (std::size_t motor = 0; motor < motor_count; ++motor)
        if (waits_[motor]) find(motor);
}

// The motor's next step, or how far it is known that there is none.
void TimedGenerator::find(std::size_t index) {
    Motor& motor = motors_[index];
    for (;;) {
        if (motor.state == Motor::State::walking) {
            const double time_s = motor.walk.next_s(motor.function);
            if (time_s != TimeWalk::no_step_s) {
                constexpr double to_nearest = 0.5;
                next_ns_[index] =
                    motor.begin.ns +
                    static_cast<std::int64_t>(motor.begin.part_ns + time_s * 1e9 + to_nearest);
                waits_[index] = false;
                return;
            }
            motor.begin = motor.begin.after(motor.function.duration_s());
        }
        if (!begin_piece(index)) return;
    }
}

bool TimedGenerator::begin_piece(std::size_t index) {
    Motor& motor = motors_[index];
    switch (motor.function.begin_piece(window_, motor.begin)) {
        case Known::piece:
            motor.walk.start(motor.function, counts_[index]);
            motor.state = Motor::State::walking;
            return true;
        case Known::nothing_yet:
            motor.state = Motor::State::waiting;
            next_ns_[index] = motor.begin.ns;
            waits_[index] = true;
            return false;
        case Known::rests_forever:
            motor.state = Motor::State::done;
            next_ns_[index] = never_ns;
            waits_[index] = false;
            return false;
    }
    return false;
}

void TimedGenerator::take(std::size_t motor, StepEvent& event) {
    const auto bit = static_cast<std::uint8_t>(1u << motor);
    const int direction = motors_[motor].walk.direction();
    event.motors |= bit;
    if (direction > 0) event.positive |= bit;
    counts_[motor] += direction;
    find(motor);
}

std::size_t TimedGenerator::next(std::span<StepEvent> events) {
    std::size_t written = 0;
    while (written < events.size()) {
        const std::int64_t soonest_ns = *std::min_element(next_ns_.begin(), next_ns_.end());
        if (soonest_ns == never_ns) break;
        bool known = true;
        for (std::size_t motor = 0; motor < motor_count; ++motor)
            known = known && !(next_ns_[motor] == soonest_ns && waits_[motor]);
        if (!known) break;
        // Rounding may put the first step of a piece before the last of the one before it.
        last_ns_ = std::max(last_ns_, soonest_ns + lead_ns_);
        StepEvent event{last_ns_};
        for (std::size_t motor = 0; motor < motor_count; ++motor)
            if (next_ns_[motor] == soonest_ns && !waits_[motor]) take(motor, event);
        events[written++] = event;
    }
    return written;
}

}  // namespace lyr::motion
