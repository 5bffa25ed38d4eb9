// The planned motion of a machine's motors evaluated forwards: from a time over the distance to a point, over
// the taps of the shaping, through the kinematics. For checking steps that were found the other way round;
// it shares no code with the generators but the taps, the paths and the speed profile's numbers.
//
// Contract
//  1. motor_steps() is exact to rounding for times from the first move that is kept to the end of the last,
//     less the reach of the taps.

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
    void forget_before(std::int64_t time_ns) {
        if (time_ns > kept_until_ns_) forget_pieces_before(time_ns);
    }

    bool empty() const { return pieces_.empty(); }
    // At a time of the steps, which lags behind the plan's by lead_ns().
    double motor_steps(std::size_t motor, std::int64_t time_ns) {
        const std::int64_t plan_ns = time_ns - lead_ns_;
        if (motor == motion::extruder_motor)
            return steps_per_mm_[motor] * shaped_mm(motion::axis_e, plan_ns);
        if (mixes_all_) return mixed_steps(motor, plan_ns);
        double at_mm = -origin_mm_[motor];
        for (std::size_t axis = 0; axis < shares_[motor].size(); ++axis)
            if (shares_[motor][axis] != 0) at_mm += shares_[motor][axis] * shaped_mm(axis, plan_ns);
        return steps_per_mm_[motor] * at_mm;
    }
    std::int64_t lead_ns() const { return lead_ns_; }
    std::int64_t reach_ns() const { return reach_ns_; }

private:
    double shaped_mm(std::size_t axis, std::int64_t plan_ns) {
        return axes_[axis].at_mm(pieces_, plan_ns);
    }
    // Of a motor that all axes move in some other way than as a sum.
    double mixed_steps(std::size_t motor, std::int64_t plan_ns);
    double carried_mm(std::size_t motor, const motion::Point& at) const;
    void forget_pieces_before(std::int64_t time_ns);

    motion::Kinematics machine_;
    std::shared_ptr<const motion::BedMesh> bed_;
    std::vector<PlanSum> axes_;
    AxisValues steps_per_mm_{};
    std::array<double, 3> origin_mm_{};              // of the motors
    bool mixes_all_ = false;                         // a delta's carriages, a bed's mesh
    std::array<std::array<double, 3>, 3> shares_{};  // otherwise: of the axes, in each motor
    std::int64_t lead_ns_ = 0, reach_ns_ = 0;
    std::int64_t kept_until_ns_ = 0;  // of the steps: no piece can be forgotten before
    PlanPieces pieces_;
    double fed_mm_ = 0, fed_error_mm_ = 0, pressed_mm_ = 0;
};

}  // namespace lyr::run
