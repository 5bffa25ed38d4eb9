#include "target/run/timed_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"

namespace lyr::run {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TimedCheck::TimedCheck(const config::Printer& printer) : plan_(printer) {
    for (std::size_t i = 0; i < printer.backlash_mm.size(); ++i)
        play_steps_[i] = printer.backlash_mm[i] * printer.axes[i].steps_per_mm;
}

void TimedCheck::expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts) {
    for (const motion::PlannedMove& move : moves) {
        plan_.append(move);
        for (int look = 1; look <= looks_per_move; ++look)
            looks_ns_.push_back(
                move.start_ns + plan_.lead_ns() +
                std::llround(move.profile.duration_s * ns_per_s * look / looks_per_move));
    }
    shifts_.append(shifts);
    next_tend_ns_ = 0;
}

void TimedCheck::step(const DecodedStep& step) {
    const std::int64_t planned_ns = shifts_.asked_ns(step.time_ns);
    if (planned_ns > next_tend_ns_) tend(planned_ns, step.before);
    const double planned_steps = planned(step.axis, planned_ns);
    const double before = at_steps_[step.axis];
    const double after =
        carried_steps(step.axis, step.before[step.axis] + (step.positive ? 1 : -1));
    measure(step.axis, std::max(std::abs(planned_steps - before), std::abs(planned_steps - after)));
    at_steps_[step.axis] = after;
}

void TimedCheck::tend(std::int64_t time_ns, const StepPositions& positions) {
    look_until(time_ns, positions);
    plan_.forget_before(time_ns);
    next_tend_ns_ = plan_.kept_until_ns();
    if (!looks_ns_.empty()) next_tend_ns_ = std::min(next_tend_ns_, looks_ns_.front());
}

void TimedCheck::finish(const StepPositions& positions) {
    if (!plan_.empty() && !looks_ns_.empty())
        looks_ns_.push_back(looks_ns_.back() + plan_.reach_ns());
    look_until(std::numeric_limits<std::int64_t>::max(), positions);
}

void TimedCheck::look_until(std::int64_t time_ns, const StepPositions& positions) {
    for (; !looks_ns_.empty() && looks_ns_.front() < time_ns; looks_ns_.pop_front())
        for (std::size_t motor = 0; motor < positions.size(); ++motor)
            measure(motor, std::abs(planned(motor, looks_ns_.front()) -
                                    carried_steps(motor, positions[motor])));
}

// A rising motor pushes the axis `play` behind it, a falling one pulls it along.
double TimedCheck::carried_steps(std::size_t motor, std::int64_t position) const {
    const auto at = static_cast<double>(position);
    return std::clamp(at_steps_[motor], at - play_steps_[motor], at);
}

double TimedCheck::planned(std::size_t motor, std::int64_t time_ns) {
    return plan_.empty() ? infinity : plan_.motor_steps(motor, time_ns);
}

void TimedCheck::measure(std::size_t motor, double off_steps) {
    off_plan_[motor] = std::max(off_plan_[motor], shown(off_steps));
}

}  // namespace lyr::run
