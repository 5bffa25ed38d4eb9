// The planned motion of a machine's motors evaluated forwards: from a time over the distance to a point, over
// the taps of the shaping, through the kinematics. For checking steps that were found the other way round;
// it shares no code with the generators but the taps, the paths and the speed profile's numbers.
//
// Contract
//  1. motor_steps() holds for times from the first move that is kept to the end of the last, less the reach of the taps;
//     it is exact to rounding, but for turns, which are within series_mm for each copy of the motion.

#pragma once

#include "target/moves/machine.h"
#include "target/run/path_check.h"
#include "target/run/plan_copy.h"

namespace lyr::run {

class ShapedPlan {
public:
    explicit ShapedPlan(const config::Printer& printer);

    void append(const motion::PlannedMove& move);
    // Nothing before this time of the steps is asked for any more.
    void forget_before(std::int64_t time_ns);
    // No piece can be forgotten before.
    std::int64_t kept_until_ns() const { return kept_until_ns_; }

    bool empty() const { return pieces_.empty(); }
    // At a time of the steps, which lags behind the plan's by lead_ns().
    double motor_steps(std::size_t motor, std::int64_t time_ns) {
        const std::int64_t plan_ns = time_ns - lead_ns_;
        const MotorSeries& known = series_[motor];
        if (plan_ns < known.begin_ns || plan_ns >= known.end_ns)
            return sought_steps(motor, plan_ns);
        return value_of(known.steps, static_cast<double>(plan_ns - known.begin_ns));
    }
    std::int64_t lead_ns() const { return lead_ns_; }
    std::int64_t reach_ns() const { return reach_ns_; }

private:
    // Of a motor that is a sum of axes: what it does from a time on, for a while.
    struct MotorSeries {
        std::int64_t begin_ns = 0, end_ns = 0;
        Series steps{};
    };

    double sought_steps(std::size_t motor, std::int64_t plan_ns);
    double shaped_mm(std::size_t axis, std::int64_t plan_ns) {
        return axes_[axis].at_mm(pieces_, plan_ns);
    }
    // Of a motor that all axes move in some other way than as a sum.
    double mixed_steps(std::size_t motor, std::int64_t plan_ns);
    double carried_mm(std::size_t motor, const motion::Point& at) const;

    motion::Kinematics machine_;
    std::shared_ptr<const motion::BedMesh> bed_;
    std::vector<PlanSum> axes_;
    AxisValues steps_per_mm_{};
    AxisValues origin_mm_{};                                // of the motors
    bool mixes_all_ = false;                                // a delta's carriages, a bed's mesh
    std::array<AxisValues, motion::motor_count> shares_{};  // otherwise: of the axes, in each motor
    std::array<MotorSeries, motion::motor_count> series_;
    std::int64_t lead_ns_ = 0, reach_ns_ = 0;
    std::int64_t kept_until_ns_ = 0;  // of the steps
    PlanPieces pieces_;
    double fed_mm_ = 0, fed_error_mm_ = 0, pressed_mm_ = 0;
};

}  // namespace lyr::run
