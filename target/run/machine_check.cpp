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
      timed_(printer) {
    for (std::size_t i = 0; i < steps_per_mm_.size(); ++i)
        steps_per_mm_[i] = printer.axes[i].steps_per_mm;
}

void MachineCheck::expect(std::span<const motion::PlannedMove> moves,
                          std::span<const Shift> shifts) {
    for (const motion::PlannedMove& move : moves) compare_path(move);
    timed_.expect(moves, shifts);
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
        const double off_mm = shown(std::abs(planned_mm[i] - file_mm[i]));
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

Status MachineCheck::finish(const StepPositions& positions) {
    timed_.finish(positions);
    PathCurve curve;
    const Result<bool> more = source_(curve);
    if (!more) return more.error();
    if (*more) path_.worst_steps = infinity;
    return status_;
}

Deviation MachineCheck::off_file() const {
    Deviation off = path_;
    if (shaped_) return off;
    const AxisValues& off_plan = timed_.off_plan();
    for (std::size_t i = 0; i < off.steps.size(); ++i) {
        off.steps[i] += off_plan[i];
        off.worst_steps = std::max(off.worst_steps, off.steps[i]);
    }
    off.distance_mm += mm_per_step_ * *std::max_element(off_plan.begin(), off_plan.end() - 1);
    return off;
}

}  // namespace lyr::run
