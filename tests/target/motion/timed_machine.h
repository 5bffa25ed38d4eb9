// As machine.h, for motors whose steps come from the timed generator: the ideal is the plan itself,
// summed over the taps and taken through the kinematics of the machine.

#pragma once

#include "machine.h"
#include "target/motion/shaper.h"
#include "target/motion/timed_generator.h"

namespace lyr::motion::test {

// In the nanosecond that times are rounded to a motor at 300 mm/s and 800 steps/mm, twice as fast on
// crossed belts, moves so much.
inline constexpr Real moved_steps = 5e-4;

struct TimedRun {
    Run run;  // its events are those of the timed generator, in the time of the plan
    Kinematics kinematics;
    Shaping shaping;
    std::int64_t lead_ns = 0, tail_ns = 0;
};

inline TimedRun timed_run(const Job& job, const Kinematics& kinematics, const Shaping& shaping) {
    TimedRun timed{{job, plan_of(job), {}, {}, 0}, kinematics, shaping};
    TimedGenerator generator(kinematics, job.origin, shaping);
    timed.lead_ns = generator.lead_ns();
    timed.tail_ns = generator.tail_ns();
    std::array<StepEvent, 64> batch;
    const auto take_all = [&] {
        std::size_t count;
        do {
            count = generator.next(batch);
            for (std::size_t i = 0; i < count; ++i) {
                timed.run.events.push_back(batch[i]);
                timed.run.events.back().time_ns -= timed.lead_ns;
            }
        } while (count == batch.size());
    };
    for (const PlannedMove& planned : timed.run.plan) {
        generator.start(planned);
        take_all();
    }
    generator.finish();
    take_all();
    timed.run.counts = generator.counts();
    timed.run.end_ns = end_ns_of(timed.run.plan.back());
    return timed;
}

class TimedIdeal {
public:
    explicit TimedIdeal(const TimedRun& timed) : timed_(timed) {
        Real pressed = 0;
        for (const PlannedMove& planned : timed.run.plan) {
            starts_ns_.push_back(static_cast<Real>(planned.start_ns) + planned.start_part_ns);
            pressed_.push_back(pressed);
            fed_.push_back(fed_.empty() ? 0 : fed_.back() + advance_of(last_));
            last_ = planned.path;
            if (presses(planned)) pressed += advance_of(planned.path);
        }
    }

    // Steps from the origin.
    Real steps_at_ns(std::size_t motor, Real time_ns) const {
        const Real steps = steps_per_mm(timed_.kinematics)[motor];
        if (motor == extruder_motor) return steps * extruder_mm(time_ns);
        std::array<Real, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = shaped(axis, time_ns);
        const Point& o = timed_.run.job.origin;
        const std::array<Real, 3> origin{o.x, o.y, o.z};
        return steps * (motor_mm(motor, at) - motor_mm(motor, origin));
    }

    Real shaped(std::size_t axis, Real time_ns) const {
        const Taps& taps = timed_.shaping.axes[axis];
        if (taps.empty()) return planned(axis, time_ns);
        Real sum = 0;
        for (const Tap& tap : taps)
            sum += tap.weights[axis] * planned(axis, time_ns + static_cast<Real>(tap.offset_ns));
        return sum;
    }

private:
    static bool presses(const PlannedMove& planned) {
        return advance_of(planned.path) > 0 && tangent_at(planned.path, 0) != Point{};
    }
    Real extruder_mm(Real time_ns) const {
        const Taps& taps = timed_.shaping.extruder;
        if (taps.empty()) return planned(axis_e, time_ns);
        Real sum = 0;
        for (const Tap& tap : taps) {
            const Real at_ns = time_ns + static_cast<Real>(tap.offset_ns);
            for (const std::size_t channel : {std::size_t{axis_e}, pressed_channel})
                if (tap.weights[channel] != 0)
                    sum += tap.weights[channel] * planned(channel, at_ns);
        }
        return sum;
    }
    Real planned(std::size_t channel, Real time_ns) const {
        const auto after = std::upper_bound(starts_ns_.begin(), starts_ns_.end(), time_ns);
        const auto index =
            static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - starts_ns_.begin() - 1));
        const PlannedMove& move = timed_.run.plan[index];
        const Real time_s = (time_ns - starts_ns_[index]) / Real{1e9};
        if (channel < axis_e) return ideal_.in_move(index, time_s)[channel];
        const Real share = ideal_.share(index, time_s);
        if (channel == axis_e) return fed_[index] + share * advance_of(move.path);
        return pressed_[index] + (presses(move) ? share * advance_of(move.path) : 0);
    }
    Real motor_mm(std::size_t motor, std::array<Real, 3> at) const {
        if (timed_.shaping.bed)
            at[2] +=
                timed_.shaping.bed->lift_mm({static_cast<double>(at[0]), static_cast<double>(at[1]),
                                             static_cast<double>(at[2])});
        if (std::holds_alternative<Cartesian>(timed_.kinematics)) return at[motor];
        if (std::holds_alternative<CoreXy>(timed_.kinematics))
            return motor == 0 ? at[0] + at[1] : motor == 1 ? at[0] - at[1] : at[2];
        const Delta::Tower& tower = std::get<Delta>(timed_.kinematics).towers[motor];
        const Real dx = at[0] - tower.x_mm, dy = at[1] - tower.y_mm;
        return at[2] +
               std::sqrt(static_cast<Real>(tower.arm_mm) * tower.arm_mm - dx * dx - dy * dy);
    }

    const TimedRun& timed_;
    Ideal ideal_{timed_.run};
    std::vector<Real> starts_ns_, pressed_, fed_;
    Path last_;
};

struct Errors {
    Real steps = 0;    // from the ideal, at and between steps
    Real time_ns = 0;  // of a step, against a bisection
};

// In one pass over the steps of a motor.
inline Errors errors_of(const TimedRun& timed, std::size_t motor) {
    constexpr int looks = 4;
    constexpr Real close_ns = 3, fine_ns = 1e-3;
    const TimedIdeal ideal(timed);
    const std::vector<MotorStep> steps = steps_of(timed.run, motor);
    Errors worst;
    std::int64_t count = 0;
    Real last_ns = -static_cast<Real>(timed.lead_ns);
    const auto look_until = [&](Real time_ns) {
        for (int i = 0; i <= looks; ++i) {
            const Real at_ns = last_ns + (time_ns - last_ns) * i / looks;
            const Real off = ideal.steps_at_ns(motor, at_ns) - static_cast<Real>(count);
            worst.steps = std::max(worst.steps, std::abs(off));
        }
        last_ns = time_ns;
    };
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Real now = static_cast<Real>(steps[i].time_ns), before = last_ns;
        look_until(now);
        const Real middle = static_cast<Real>(count) + steps[i].direction / Real{2};
        const auto passed = [&](Real time_ns) {
            return (ideal.steps_at_ns(motor, time_ns) - middle) * steps[i].direction >= 0;
        };
        const Real after =
            i + 1 < steps.size() ? static_cast<Real>(steps[i + 1].time_ns) : now + Real{1e6};
        // As far out as it takes to find it on both sides, but not to the neighbours.
        Real reach = close_ns;
        Real low = now, high = now;
        while (reach < Real{1e6} && !(!passed(low) && passed(high))) {
            low = std::max((before + now) / 2, now - reach);
            high = std::min((after + now) / 2, now + reach);
            if (low <= (before + now) / 2 && high >= (after + now) / 2) break;
            reach *= 4;
        }
        if (passed(low) || !passed(high)) {
            worst.time_ns = std::max(worst.time_ns, after - before);
        } else {
            worst.time_ns =
                std::max(worst.time_ns, std::abs(first_passed(low, high, fine_ns, passed) - now));
        }
        count += steps[i].direction;
    }
    look_until(timed.run.end_ns + static_cast<Real>(timed.tail_ns));
    CHECK(count == timed.run.counts[motor]);
    return worst;
}

}  // namespace lyr::motion::test
