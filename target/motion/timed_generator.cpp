// Each motor runs ahead on its own to its next step or to where the plan ends for it; the soonest step that
// no motor may still come before is the next event.

#include "target/motion/timed_generator.h"

#include <algorithm>

#include "base/constants.h"

namespace lyr::motion {
namespace {

constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

TimedGenerator::TimedGenerator(const Kinematics& kinematics, const Point& origin,
                               const Shaping& shaping)
    : motors_{{{function_of(kinematics, axis_x, origin, shaping),
                TimeWalk(shaping.play_steps[axis_x]),
                {}},
               {function_of(kinematics, axis_y, origin, shaping),
                TimeWalk(shaping.play_steps[axis_y]),
                {}},
               {function_of(kinematics, axis_z, origin, shaping),
                TimeWalk(shaping.play_steps[axis_z]),
                {}},
               {extruder_of(kinematics, shaping), TimeWalk(), {}}}} {
    for (const Motor& motor : motors_) {
        lead_ns_ = std::max(lead_ns_, motor.function.ahead_ns());
        behind_ns_ = std::max(behind_ns_, motor.function.behind_ns());
    }
    for (Motor& motor : motors_) motor.begin = {-lead_ns_, 0};
    next_ns_.fill(-lead_ns_);
    note_waiting();
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
        if (motors_[motor].state == Motor::State::waiting) find(motor);
    note_waiting();
}

void TimedGenerator::note_waiting() {
    wait_ns_ = never_ns;
    for (std::size_t motor = 0; motor < motor_count; ++motor)
        if (motors_[motor].state == Motor::State::waiting)
            wait_ns_ = std::min(wait_ns_, next_ns_[motor]);
}

// The motor's next steps, or how far it is known that there is none.
void TimedGenerator::find(std::size_t index) {
    Motor& motor = motors_[index];
    for (;;) {
        if (motor.state == Motor::State::walking) {
            const std::span<const double> times_s = motor.walk.next_s(motor.function);
            if (!times_s.empty()) return keep(index, times_s);
            motor.begin = motor.begin.after(motor.function.duration_s());
        }
        if (!begin_piece(index)) return;
    }
}

void TimedGenerator::keep(std::size_t index, std::span<const double> times_s) {
    constexpr double to_nearest = 0.5;
    Motor& motor = motors_[index];
    const double from_ns = motor.begin.part_ns + to_nearest;
    motor.next = motor.end = 0;
    for (const double time_s : times_s)
        motor.times_ns[motor.end++] =
            motor.begin.ns + static_cast<std::int64_t>(from_ns + time_s * ns_per_s);
    next_ns_[index] = motor.times_ns[motor.next++];
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
            note_waiting();
            return false;
        case Known::rests_forever:
            motor.state = Motor::State::done;
            next_ns_[index] = never_ns;
            return false;
    }
    return false;
}

inline bool TimedGenerator::take(std::size_t index) {
    Motor& motor = motors_[index];
    const bool rises = motor.walk.direction() > 0;
    counts_[index] += rises ? 1 : -1;
    if (motor.next < motor.end)
        next_ns_[index] = motor.times_ns[motor.next++];
    else
        find(index);
    return rises;
}

std::size_t TimedGenerator::next(std::span<StepEvent> events) {
    std::size_t written = 0;
    while (written < events.size()) {
        const auto [x_ns, y_ns, z_ns, e_ns] = next_ns_;
        const std::int64_t soonest_ns = std::min(std::min(x_ns, y_ns), std::min(z_ns, e_ns));
        if (soonest_ns >= wait_ns_) break;
        // Rounding may put the first step of a piece before the last of the one before it.
        last_ns_ = std::max(last_ns_, soonest_ns + lead_ns_);
        unsigned motors = 0, positive = 0;
        // Four branches that are guessed are quicker than the number of the soonest, which is waited for.
        for (std::size_t motor = 0; motor < motor_count; ++motor)
            if (next_ns_[motor] == soonest_ns) {
                motors |= 1u << motor;
                positive |= unsigned{take(motor)} << motor;
            }
        events[written++] = {last_ns_, static_cast<std::uint8_t>(motors),
                             static_cast<std::uint8_t>(positive)};
    }
    return written;
}

}  // namespace lyr::motion
