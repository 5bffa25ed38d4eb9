#include "target/motion/motor_function.h"

#include <algorithm>
#include <limits>

#include "base/constants.h"

namespace lyr::motion {
namespace {

constexpr std::int64_t forever_ns = std::numeric_limits<std::int64_t>::max();
// What is left of a phase when it is as good as over: the rounding of a day in seconds, and a thousandth
// of what a step's time is rounded to.
constexpr double instant_s = 1e-12;
// An arm that lies flatter than this share of its length would pull sideways only; nothing but the
// bounds needs it, reach is checked before.
constexpr double least_height_share = 0.05;

Sample product(const Sample& a, const Sample& b) {
    return {a.position * b.position, a.speed * b.position + a.position * b.speed,
            a.acceleration * b.position + 2 * a.speed * b.speed + a.position * b.acceleration};
}

// Of mm and seconds; that squares might overflow, as hypot() takes care of, is no matter here.
double size(double x, double y) {
    return std::sqrt(x * x + y * y);
}

// Sizes of a function and of its first three derivatives.
using Sizes = std::array<double, 4>;

Sizes product(const Sizes& a, const Sizes& b) {
    return {a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2 * a[1] * b[1] + a[0] * b[2],
            a[3] * b[0] + 3 * a[2] * b[1] + 3 * a[1] * b[2] + a[0] * b[3]};
}

}  // namespace

Instant Instant::after(double time_s) const {
    const double sum_ns = part_ns + time_s * ns_per_s;
    const double whole_ns = std::floor(sum_ns);
    return {ns + static_cast<std::int64_t>(whole_ns), sum_ns - whole_ns};
}

MotorFunction::MotorFunction(const Taps& taps, bool in_space) : in_space_(in_space) {
    for (const Tap& tap : taps) cursors_.push_back({tap});
}

MotorFunction MotorFunction::sum(const Taps& taps, double start_steps) {
    MotorFunction function(taps, false);
    function.start_ = start_steps;
    return function;
}

MotorFunction MotorFunction::in_space(const Taps& taps, const std::optional<Delta::Tower>& tower,
                                      std::shared_ptr<const BedMesh> bed, double steps_per_mm,
                                      double start_mm) {
    MotorFunction function(taps, true);
    function.tower_ = tower;
    function.bed_ = std::move(bed);
    function.steps_per_mm_ = steps_per_mm;
    function.start_ = start_mm;
    return function;
}

std::uint64_t MotorFunction::oldest_move() const {
    std::uint64_t oldest = std::numeric_limits<std::uint64_t>::max();
    for (const Cursor& cursor : cursors_) oldest = std::min(oldest, cursor.move);
    return oldest;
}

std::int64_t MotorFunction::ahead_ns() const {
    std::int64_t ahead_ns = 0;
    for (const Cursor& cursor : cursors_) ahead_ns = std::max(ahead_ns, cursor.tap.offset_ns);
    return ahead_ns;
}

std::int64_t MotorFunction::behind_ns() const {
    std::int64_t behind_ns = 0;
    for (const Cursor& cursor : cursors_) behind_ns = std::max(behind_ns, -cursor.tap.offset_ns);
    return behind_ns;
}

Known MotorFunction::begin_piece(const MoveWindow& window, const Instant& begin) {
    if (window.end() == 0)
        return window.rests_until_ns() == forever_ns ? Known::rests_forever : Known::nothing_yet;
    for (Smooth& smooth : smooth_) smooth.clear();
    duration_s_ = std::numeric_limits<double>::infinity();
    for (Cursor& cursor : cursors_)
        if (!add(cursor, window, begin)) return Known::nothing_yet;
    if (duration_s_ == std::numeric_limits<double>::infinity()) {
        duration_s_ = 0;
        return Known::rests_forever;
    }
    if (bed_) stay_in_cell();
    limit_jerk();
    return Known::piece;
}

bool MotorFunction::add(Cursor& cursor, const MoveWindow& window, const Instant& begin) {
    const Instant here{begin.ns + cursor.tap.offset_ns, begin.part_ns};
    for (;;) {
        const ChannelMove& move = window.at(cursor.move);
        const double since_s = here.seconds_since({move.start_ns, move.start_part_ns});
        if (since_s < -instant_s) {
            // Before the first move; before a later one its predecessor still has the cursor.
            add_rest(cursor.tap, move.from);
            end_no_later_than(-since_s);
            return true;
        }
        if (move.profile.duration_s - since_s > instant_s) {
            add_moving(cursor, move, since_s);
            return true;
        }
        if (cursor.move + 1 == window.end()) {
            const std::int64_t until_ns = window.rests_until_ns();
            if (until_ns <= here.ns) return false;
            add_rest(cursor.tap, move.to);
            if (until_ns != forever_ns) end_no_later_than(Instant{until_ns, 0}.seconds_since(here));
            return true;
        }
        const ChannelMove& next = window.at(cursor.move + 1);
        const double to_next_s = Instant{next.start_ns, next.start_part_ns}.seconds_since(here);
        if (to_next_s > instant_s) {
            add_rest(cursor.tap, move.to);
            end_no_later_than(to_next_s);
            return true;
        }
        ++cursor.move;
        cursor.phase = 0;
        cursor.place.is_known = false;
    }
}

void MotorFunction::add_rest(const Tap& tap, const ChannelValues& at) {
    for (std::size_t channel = 0; channel < channel_count; ++channel)
        if (tap.weights[channel] != 0)
            smooth_of(channel).add_constant(tap.weights[channel] * at[channel]);
}

void MotorFunction::add_moving(Cursor& cursor, const ChannelMove& move, double since_s) {
    const auto& phases = move.profile.phases;
    while (cursor.phase + 1 < phases.size() &&
           phases[cursor.phase + 1].time_s - since_s <= instant_s) {
        ++cursor.phase;
        cursor.place.is_known = false;
    }
    const Phase& phase = phases[cursor.phase];
    const bool is_last = cursor.phase + 1 == phases.size();
    const double left_s =
        (is_last ? move.profile.duration_s : phases[cursor.phase + 1].time_s) - since_s;
    end_no_later_than(left_s);
    const double t = since_s - phase.time_s;
    const double speed =
        phase.speed_mm_s + t * (phase.acceleration_mm_s2 + t * phase.jerk_mm_s3 / 2);
    const double half_acceleration = (phase.acceleration_mm_s2 + t * phase.jerk_mm_s3) / 2;
    const double sixth_jerk = phase.jerk_mm_s3 / 6;
    const double distance_mm =
        phase.distance_mm +
        t * (phase.speed_mm_s + t * (phase.acceleration_mm_s2 / 2 + t * phase.jerk_mm_s3 / 6));
    const ChannelValues& weights = cursor.tap.weights;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (weights[channel] == 0 || (move.turns && channel <= axis_y)) continue;
        const double slope = weights[channel] * move.slope[channel];
        smooth_of(channel).add_cubic(weights[channel] * move.from[channel] + slope * distance_mm,
                                     slope * speed, slope * half_acceleration, slope * sixth_jerk);
    }
    if (!move.turns || (weights[axis_x] == 0 && weights[axis_y] == 0)) return;
    add_turn(cursor, move, distance_mm,
             {move.rate * speed, move.rate * half_acceleration, move.rate * sixth_jerk});
    // The speed of a phase is highest at one of its ends, or it has no jerk.
    const double end_speed = speed + left_s * (2 * half_acceleration + left_s * 3 * sixth_jerk);
    const double fastest = std::abs(move.rate) * std::max(speed, end_speed);
    if (fastest > 0) end_no_later_than(Smooth::largest_turn_rad / fastest);
}

// As a chord from the start, as in path.cpp.
MotorFunction::OnCircle MotorFunction::place_on(const ChannelMove& move, double turned_rad) {
    const double half_rad = turned_rad / 2, angle_rad = move.start_angle_rad + turned_rad;
    const double chord_mm = 2 * move.radius_mm * std::sin(half_rad);
    const double chord_angle_rad = move.start_angle_rad + half_rad;
    return {turned_rad,
            move.start.x - chord_mm * std::sin(chord_angle_rad),
            move.start.y + chord_mm * std::cos(chord_angle_rad),
            move.radius_mm * std::sin(angle_rad),
            move.radius_mm * std::cos(angle_rad),
            true};
}

// A phase has few pieces: what they round adds up to less than a place that is found anew.
void MotorFunction::turn_on(OnCircle& place, double turned_rad) {
    const auto [sine, versine] = Smooth::turned(turned_rad - place.turned_rad);
    const double along_x = -place.sine_mm, along_y = place.cosine_mm;
    place.turned_rad = turned_rad;
    place.x_mm += along_x * sine - along_y * versine;
    place.y_mm += along_y * sine + along_x * versine;
    place.sine_mm += along_y * sine + along_x * versine;
    place.cosine_mm += along_x * sine - along_y * versine;
}

void MotorFunction::add_turn(Cursor& cursor, const ChannelMove& move, double distance_mm,
                             const TurnAngle& angle) {
    OnCircle& place = cursor.place;
    if (place.is_known)
        turn_on(place, move.rate * distance_mm);
    else
        place = place_on(move, move.rate * distance_mm);
    const double sine = place.sine_mm, cosine = place.cosine_mm;
    const double wx = cursor.tap.weights[axis_x], wy = cursor.tap.weights[axis_y];
    if (in_space_) {
        smooth_[axis_x].add_constant(wx * place.x_mm);
        smooth_[axis_y].add_constant(wy * place.y_mm);
        if (wx != 0) smooth_[axis_x].add_turn({angle, -wx * sine, -wx * cosine});
        if (wy != 0) smooth_[axis_y].add_turn({angle, wy * cosine, -wy * sine});
        return;
    }
    smooth_[0].add_constant(wx * place.x_mm + wy * place.y_mm);
    smooth_[0].add_turn({angle, wy * cosine - wx * sine, -wx * cosine - wy * sine});
}

// Chooses the cell, and ends the piece where the head leaves it.
void MotorFunction::stay_in_cell() {
    const Point at{smooth_[axis_x].at(0).position, smooth_[axis_y].at(0).position,
                   smooth_[axis_z].at(0).position};
    const std::array<double, 3> place_mm{at.x, at.y, at.z};
    for (std::size_t i = 0; cell_ && i < place_mm.size(); ++i)
        if (place_mm[i] < cell_->low_mm[i] - cell_overlap_mm / 2 ||
            place_mm[i] > cell_->high_mm[i] + cell_overlap_mm / 2)
            cell_.reset();
    if (!cell_) cell_ = bed_->cell_at(at);
    for (std::size_t i = 0; i < smooth_.size(); ++i)
        end_no_later_than(smooth_[i].leaves(cell_->low_mm[i] - cell_overlap_mm,
                                            cell_->high_mm[i] + cell_overlap_mm,
                                            cell_overlap_mm / 10, duration_s_));
}

Sample MotorFunction::lift_at(const std::array<Sample, 3>& at) const {
    const MeshCell& cell = *cell_;
    Sample u = at[axis_x], v = at[axis_y];
    u.position -= cell.x_mm;
    v.position -= cell.y_mm;
    const Sample uv = product(u, v);
    const auto height = [&](double Sample::*of) {
        return cell.slope_x * u.*of + cell.slope_y * v.*of + cell.twist_per_mm * uv.*of;
    };
    const Sample& z = at[axis_z];
    return product(
        Sample{cell.height_mm + height(&Sample::position), height(&Sample::speed),
               height(&Sample::acceleration)},
        Sample{cell.share + cell.share_slope_per_mm * z.position, cell.share_slope_per_mm * z.speed,
               cell.share_slope_per_mm * z.acceleration});
}

double MotorFunction::lift_jerk(const std::array<Bounds, 3>& bounds) const {
    const MeshCell& cell = *cell_;
    const auto sizes = [&](std::size_t axis, double from_mm) {
        const Bounds& own = bounds[axis];
        return Sizes{std::abs(smooth_[axis].at(0).position - from_mm) + own.speed * duration_s_,
                     own.speed, own.acceleration, own.jerk()};
    };
    const Sizes u = sizes(axis_x, cell.x_mm), v = sizes(axis_y, cell.y_mm), z = sizes(axis_z, 0);
    const Sizes uv = product(u, v);
    Sizes height{}, share{};
    for (std::size_t i = 0; i < height.size(); ++i) {
        height[i] = std::abs(cell.slope_x) * u[i] + std::abs(cell.slope_y) * v[i] +
                    std::abs(cell.twist_per_mm) * uv[i];
        share[i] = std::abs(cell.share_slope_per_mm) * z[i];
    }
    height[0] += std::abs(cell.height_mm);
    share[0] += cell.share;
    return product(height, share)[3];
}

Sample MotorFunction::at(double time_s) const {
    if (!in_space_) {
        Sample sample = smooth_[0].at(time_s);
        sample.position -= start_;
        return sample;
    }
    const std::array<Sample, 3> head{smooth_[axis_x].at(time_s), smooth_[axis_y].at(time_s),
                                     smooth_[axis_z].at(time_s)};
    Sample z = head[axis_z];
    const auto raise = [&z](const Sample& by) {
        z = {z.position + by.position, z.speed + by.speed, z.acceleration + by.acceleration};
    };
    if (bed_) raise(lift_at(head));
    if (tower_) raise(height_over_head(head[axis_x], head[axis_y]));
    return {steps_per_mm_ * (z.position - start_), steps_per_mm_ * z.speed,
            steps_per_mm_ * z.acceleration};
}

Series MotorFunction::series(double time_s) const {
    if (!in_space_) {
        Series series = smooth_[0].series(time_s);
        series[0] -= start_;
        return series;
    }
    const Sample sample = at(time_s);
    return {sample.position, sample.speed, sample.acceleration / 2, 0, 0, 0};
}

// g = sqrt(q), q = arm^2 - |p|^2, p the way from the tower.
Sample MotorFunction::height_over_head(const Sample& x, const Sample& y) const {
    const double px = x.position - tower_->x_mm, py = y.position - tower_->y_mm;
    const double off_mm = std::sqrt(px * px + py * py);
    const double q = std::max(std::numeric_limits<double>::min(),
                              (tower_->arm_mm - off_mm) * (tower_->arm_mm + off_mm));
    const double g = std::sqrt(q);
    const double half_q1 = -(px * x.speed + py * y.speed);
    const double half_q2 =
        -(x.speed * x.speed + y.speed * y.speed + px * x.acceleration + py * y.acceleration);
    const double g1 = half_q1 / g;
    return {g, g1, (half_q2 - g1 * g1) / g};
}

void MotorFunction::limit_jerk() {
    if (!in_space_) {
        const Bounds own = smooth_[0].bounds(duration_s_);
        least_jerk_ = own.least_jerk;
        most_jerk_ = own.most_jerk;
        constexpr double factorial_of_6 = 720;
        remainder_ = {0, own.sixth / factorial_of_6};
        return;
    }
    std::array<Bounds, 3> bounds;
    for (std::size_t i = 0; i < bounds.size(); ++i) bounds[i] = smooth_[i].bounds(duration_s_);
    const double lift = bed_ ? lift_jerk(bounds) : 0, above = tower_ ? jerk_over_head(bounds) : 0;
    most_jerk_ = std::abs(steps_per_mm_) * (bounds[axis_z].jerk() + lift + above);
    least_jerk_ = -most_jerk_;
    constexpr double factorial_of_3 = 6;
    remainder_ = {most_jerk_ / factorial_of_3, 0};
}

// Of the root: g g' = q'/2, g g'' = q''/2 - g'^2, g g''' = q'''/2 - 3 g' g''.
double MotorFunction::jerk_over_head(const std::array<Bounds, 3>& bounds) const {
    const Bounds &x = bounds[axis_x], &y = bounds[axis_y];
    const double v = size(x.speed, y.speed), a = size(x.acceleration, y.acceleration);
    const double j = size(x.jerk(), y.jerk());
    const double off_mm = size(smooth_[axis_x].at(0).position - tower_->x_mm,
                               smooth_[axis_y].at(0).position - tower_->y_mm) +
                          v * duration_s_;
    const double height_mm =
        std::sqrt(std::max(0.0, (tower_->arm_mm - off_mm) * (tower_->arm_mm + off_mm)));
    const double g = std::max(height_mm, least_height_share * tower_->arm_mm);
    const double g1 = off_mm * v / g;
    const double g2 = (v * v + off_mm * a + g1 * g1) / g;
    return (3 * v * a + off_mm * j + 3 * g1 * g2) / g;
}

}  // namespace lyr::motion
