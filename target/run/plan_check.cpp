// Times are kept relative to their move's begin, so that a long print does not cost precision.

#include "target/run/plan_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"

namespace lyr::run {
namespace {

double coordinate(const motion::Point& point, std::size_t axis) {
    return axis == motion::axis_x ? point.x : axis == motion::axis_y ? point.y : point.z;
}

}  // namespace

void PlanCheck::expect(std::span<const motion::PlannedMove> moves, std::span<const Shift> shifts) {
    for (const motion::PlannedMove& move : moves) append(move);
    shifts_.append(shifts);
}

void PlanCheck::append(const motion::PlannedMove& move) {
    Piece& piece = pieces_.emplace_back();
    piece.move = move;
    piece.e_start_mm = e_end_mm_;
    const double due_mm = motion::advance_of(move.path) - e_error_mm_;
    e_end_mm_ = piece.e_start_mm + due_mm;
    e_error_mm_ = (e_end_mm_ - piece.e_start_mm) - due_mm;
    if (const auto* arc = std::get_if<motion::Arc>(&move.path)) {
        constexpr double quarter_rad = std::numbers::pi / 2;
        const double sign = arc->sweep_rad < 0 ? -1 : 1;
        // In the sense of rotation, from the start on.
        const double from = sign * arc->start_angle_rad / quarter_rad;
        const double to = from + std::abs(arc->sweep_rad) / quarter_rad;
        for (double quarter = std::floor(from) + 1; quarter < to; ++quarter) {
            const double share = (quarter - from) / (to - from);
            piece.looks_s[piece.look_count++] =
                move.profile.time_at(share * move.profile.length_mm);
        }
    }
    piece.looks_s[piece.look_count++] = move.profile.duration_s;
}

void PlanCheck::step(const DecodedStep& step) {
    const std::int64_t planned_ns = shifts_.asked_ns(step.time_ns);
    look_until(planned_ns, step.before);
    if (pieces_.empty()) {
        // Nothing was planned for this step at all: as far off as can be.
        deviation_steps_[step.axis] = std::numeric_limits<double>::infinity();
        return;
    }
    const Piece& piece = pieces_.front();
    const double planned = planned_mm(piece, step.axis, since_start_s(piece, planned_ns));
    const std::int64_t before = step.before[step.axis];
    measure(step.axis, planned, before);
    measure(step.axis, planned, before + (step.positive ? 1 : -1));
}

void PlanCheck::finish(const StepPositions& positions) {
    look_until(std::numeric_limits<std::int64_t>::max(), positions);
}

double PlanCheck::since_start_s(const Piece& piece, std::int64_t time_ns) {
    return (static_cast<double>(time_ns - piece.move.start_ns) - piece.move.start_part_ns) /
           ns_per_s;
}

// Looks at everything up to `time_ns`; the first piece is then the one of that time, or the last.
void PlanCheck::look_until(std::int64_t time_ns, const StepPositions& positions) {
    while (!pieces_.empty()) {
        Piece& piece = pieces_.front();
        const double now_s = since_start_s(piece, time_ns);
        for (; piece.looked < piece.look_count && piece.looks_s[piece.looked] <= now_s;
             ++piece.looked)
            for (std::size_t i = 0; i < positions.size(); ++i)
                measure(i, planned_mm(piece, i, piece.looks_s[piece.looked]), positions[i]);
        const bool next_began = pieces_.size() > 1 && since_start_s(pieces_[1], time_ns) >= 0;
        if (!next_began || piece.looked < piece.look_count) return;
        pieces_.pop_front();
    }
}

double PlanCheck::planned_mm(const Piece& piece, std::size_t axis, double time_s) {
    const motion::Profile& profile = piece.move.profile;
    const double distance_mm = profile.distance_at(std::clamp(time_s, 0.0, profile.duration_s));
    const double share = distance_mm / profile.length_mm;
    if (axis == motion::axis_e)
        return piece.e_start_mm + share * motion::advance_of(piece.move.path);
    if (axis != motion::axis_z && std::holds_alternative<motion::Arc>(piece.move.path)) {
        const motion::Point point = motion::point_at(piece.move.path, distance_mm);
        return axis == motion::axis_x ? point.x : point.y;
    }
    const double from_mm = coordinate(motion::start_of(piece.move.path), axis);
    return from_mm + share * (coordinate(motion::end_of(piece.move.path), axis) - from_mm);
}

void PlanCheck::measure(std::size_t axis, double planned_mm, std::int64_t position) {
    const double planned_steps = (planned_mm - origin_mm_[axis]) * steps_per_mm_[axis];
    deviation_steps_[axis] = std::max(
        deviation_steps_[axis], shown(std::abs(planned_steps - static_cast<double>(position))));
}

}  // namespace lyr::run
