#include "target/run/machine_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lyr::run {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Row = std::array<double, 3>;
using Rows = std::array<Row, 3>;

// How much each motor moves by x, y and z.
Rows rows_at(const motion::Kinematics& machine, const motion::Point& at) {
    if (std::holds_alternative<motion::CoreXy>(machine))
        return {{{1, 1, 0}, {1, -1, 0}, {0, 0, 1}}};
    Rows rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (const auto* delta = std::get_if<motion::Delta>(&machine))
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const motion::Delta::Tower& tower = delta->towers[i];
            const double dx = at.x - tower.x_mm, dy = at.y - tower.y_mm;
            const double height_mm = std::sqrt(tower.arm_mm * tower.arm_mm - dx * dx - dy * dy);
            rows[i] = {-dx / height_mm, -dy / height_mm, 1};
        }
    return rows;
}

Row cross(const Row& a, const Row& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Row& a, const Row& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The way of the head when the motors move by `off`: Cramer's rule with cross products.
double way_mm(const Rows& rows, const Row& off) {
    const Row yz = cross(rows[1], rows[2]), zx = cross(rows[2], rows[0]),
              xy = cross(rows[0], rows[1]);
    const double volume = dot(rows[0], yz);
    double squared = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
        const double moved = (off[0] * yz[i] + off[1] * zx[i] + off[2] * xy[i]) / volume;
        squared += moved * moved;
    }
    return std::sqrt(squared);
}

AxisValues axes_of(const motion::Point& at, double fed_mm) {
    return {at.x, at.y, at.z, fed_mm};
}

}  // namespace

MachineCheck::MachineCheck(const config::Printer& printer, CurveSource source)
    : machine_(moves::kinematics_of(printer)),
      shaped_(moves::is_shaped(printer)),
      source_(std::move(source)),
      plan_(printer) {
    for (std::size_t i = 0; i < steps_per_mm_.size(); ++i)
        steps_per_mm_[i] = printer.axes[i].steps_per_mm;
    for (std::size_t i = 0; i < printer.backlash_mm.size(); ++i)
        play_steps_[i] = printer.backlash_mm[i] * steps_per_mm_[i];
}

void MachineCheck::expect(std::span<const motion::PlannedMove> moves,
                          std::span<const Shift> shifts) {
    for (const motion::PlannedMove& move : moves) {
        compare_path(move);
        plan_.append(move);
        for (int look = 1; look <= looks_per_move; ++look)
            looks_ns_.push_back(
                move.start_ns + plan_.lead_ns() +
                std::llround(move.profile.duration_s * 1e9 * look / looks_per_move));
    }
    shifts_.insert(shifts_.end(), shifts.begin(), shifts.end());
}

void MachineCheck::compare_path(const motion::PlannedMove& move) {
    PathCurve curve;
    const Result<bool> more = source_(curve);
    if (!more) {
        status_ = more.error();
        return;
    }
    if (!*more) {
        path_.worst_steps = infinity;
        return;
    }
    constexpr int places = 4;
    const double length_mm = move.profile.length_mm;
    for (int place = 0; place <= places; ++place) {
        const double share = static_cast<double>(place) / places;
        const motion::Point at = motion::point_at(move.path, share * length_mm);
        measure_path(axes_of(at, share * motion::advance_of(move.path)), curve, share);
    }
    stretch(motion::end_of(move.path));
}

void MachineCheck::measure_path(const AxisValues& planned_mm, const PathCurve& curve,
                                double share) {
    AxisValues file_mm = curve.at(share);
    file_mm[config::axis_e] -= curve.from_mm[config::axis_e];
    double squared_mm2 = 0;
    for (std::size_t i = 0; i < file_mm.size(); ++i) {
        const double off_mm = std::abs(planned_mm[i] - file_mm[i]);
        if (i != config::axis_e) squared_mm2 += off_mm * off_mm;
        const double off_steps = off_mm * steps_per_mm_[i];
        if (off_steps <= path_.steps[i]) continue;
        path_.steps[i] = off_steps;
        if (off_steps <= path_.worst_steps) continue;
        path_.worst_steps = off_steps;
        path_.worst_axis = i;
        path_.worst_layer = curve.layer;
        path_.worst_at_mm = curve.at(share);
    }
    path_.distance_mm = std::max(path_.distance_mm, std::sqrt(squared_mm2));
}

// Motors that are all off, each to whichever side is worst.
void MachineCheck::stretch(const motion::Point& at) {
    const Rows rows = rows_at(machine_, at);
    const Row steps_mm{1 / steps_per_mm_[0], 1 / steps_per_mm_[1], 1 / steps_per_mm_[2]};
    for (const double second : {1.0, -1.0})
        for (const double third : {1.0, -1.0})
            mm_per_step_ =
                std::max(mm_per_step_,
                         way_mm(rows, {steps_mm[0], second * steps_mm[1], third * steps_mm[2]}));
}

void MachineCheck::step(const DecodedStep& step) {
    while (!shifts_.empty() && shifts_.front().from_ns <= step.time_ns) {
        shift_ns_ = shifts_.front().shift_ns;
        shifts_.pop_front();
    }
    const std::int64_t planned_ns = step.time_ns - shift_ns_;
    look_until(planned_ns, step.before);
    const std::int64_t before = step.before[step.axis];
    const std::int64_t after = before + (step.positive ? 1 : -1);
    const double planned_steps = planned(step.axis, planned_ns);
    measure(step.axis, planned_steps, before);
    at_steps_[step.axis] = carried_steps(step.axis, after);
    measure(step.axis, planned_steps, after);
    plan_.forget_before(planned_ns);
}

Status MachineCheck::finish(const StepPositions& positions) {
    if (!plan_.empty() && !looks_ns_.empty())
        looks_ns_.push_back(looks_ns_.back() + plan_.reach_ns());
    look_until(std::numeric_limits<std::int64_t>::max(), positions);
    PathCurve curve;
    const Result<bool> more = source_(curve);
    if (!more) return more.error();
    if (*more) path_.worst_steps = infinity;
    return status_;
}

void MachineCheck::look_until(std::int64_t time_ns, const StepPositions& positions) {
    for (; !looks_ns_.empty() && looks_ns_.front() < time_ns; looks_ns_.pop_front())
        for (std::size_t motor = 0; motor < positions.size(); ++motor)
            measure(motor, planned(motor, looks_ns_.front()), positions[motor]);
}

// A rising motor pushes the axis `play` behind it, a falling one pulls it along.
double MachineCheck::carried_steps(std::size_t motor, std::int64_t position) const {
    const auto at = static_cast<double>(position);
    return std::clamp(at_steps_[motor], at - play_steps_[motor], at);
}

double MachineCheck::planned(std::size_t motor, std::int64_t time_ns) {
    return plan_.empty() ? infinity : plan_.motor_steps(motor, time_ns);
}

void MachineCheck::measure(std::size_t motor, double planned_steps, std::int64_t position) {
    const double off_steps = std::abs(planned_steps - carried_steps(motor, position));
    // Not the other way round: what is not a number must show.
    if (!(off_steps <= off_plan_[motor])) off_plan_[motor] = off_steps;
}

Deviation MachineCheck::off_file() const {
    Deviation off = path_;
    if (shaped_) return off;
    for (std::size_t i = 0; i < off.steps.size(); ++i) {
        off.steps[i] += off_plan_[i];
        off.worst_steps = std::max(off.worst_steps, off.steps[i]);
    }
    off.distance_mm += mm_per_step_ * *std::max_element(off_plan_.begin(), off_plan_.end() - 1);
    return off;
}

}  // namespace lyr::run
