// Each motor's next step waits with its time in whole nanoseconds; the soonest of them is the next
// event.

#include "target/motion/step_generator.h"

#include <algorithm>

#include "base/constants.h"

namespace lyr::motion {
namespace {

constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

StepGenerator::StepGenerator(const LinearKinematics& kinematics, const Point& origin)
    : kinematics_(kinematics), origin_(origin) {
    next_ns_.fill(never_ns);
}

void StepGenerator::start(const PlannedMove& planned) {
    profile_ = planned.profile;
    start_ns_ = planned.start_ns;
    start_part_ns_ = planned.start_part_ns;
    MotorPaths paths = motor_paths(kinematics_, planned.path, origin_);
    std::visit([this](auto& function) { function.start += extruder_part_; }, paths[extruder_motor]);
    for (std::size_t motor = 0; motor < motor_count; ++motor) {
        Pending& pending = pending_[motor];
        pending.walk.start(paths[motor], profile_.length_mm,
                           motor == extruder_motor ? 0 : counts_[motor]);
        pending.phase = 0;
        find(motor);
    }
}

void StepGenerator::find(std::size_t motor) {
    Pending& pending = pending_[motor];
    const double distance_mm = pending.walk.next_mm();
    if (distance_mm == MotorWalk::no_step_mm) {
        next_ns_[motor] = never_ns;
        if (motor == extruder_motor)
            extruder_part_ = pending.walk.end() - static_cast<double>(pending.walk.count());
        return;
    }
    while (pending.phase + 1 < Profile::phase_count &&
           profile_.phases[pending.phase + 1].distance_mm <= distance_mm)
        ++pending.phase;
    const double time_s = time_in_phase(profile_.phases[pending.phase], distance_mm);
    constexpr double to_nearest = 0.5;
    next_ns_[motor] = static_cast<std::int64_t>(start_part_ns_ + time_s * ns_per_s + to_nearest);
}

void StepGenerator::take(std::size_t motor, StepEvent& event) {
    const auto bit = static_cast<std::uint8_t>(1u << motor);
    const int direction = pending_[motor].walk.direction();
    event.motors |= bit;
    if (direction > 0) event.positive |= bit;
    counts_[motor] += direction;
    find(motor);
}

std::size_t StepGenerator::next(std::span<StepEvent> events) {
    std::size_t written = 0;
    while (written < events.size()) {
        const std::int64_t soonest_ns = *std::min_element(next_ns_.begin(), next_ns_.end());
        if (soonest_ns == never_ns) break;
        // Rounding may put the first step of a move before the last of the one before it.
        last_ns_ = std::max(last_ns_, start_ns_ + soonest_ns);
        StepEvent event{last_ns_};
        for (std::size_t motor = 0; motor < motor_count; ++motor)
            if (next_ns_[motor] == soonest_ns) take(motor, event);
        events[written++] = event;
    }
    return written;
}

}  // namespace lyr::motion
