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

// Of the bed over the head, which is u and v from the cell's corner.
template <std::size_t count>
Powers<count> lift(const MeshCell& cell, const Powers<count>& u, const Powers<count>& v,
                   const Powers<count>& z) {
    Powers<count> height = product(u, v), share{};
    for (std::size_t i = 0; i < count; ++i) {
        height[i] = cell.twist_per_mm * height[i] + cell.slope_x * u[i] + cell.slope_y * v[i];
        share[i] = cell.share_slope_per_mm * z[i];
    }
    return product(plus(height, cell.height_mm), plus(share, cell.share));
}

MeshCell sizes_of(MeshCell cell) {
    for (double* value : {&cell.height_mm, &cell.slope_x, &cell.slope_y, &cell.twist_per_mm,
                          &cell.share, &cell.share_slope_per_mm})
        *value = std::abs(*value);
    return cell;
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
    set_bounds();
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
    const double way_x_mm = along_x * sine - along_y * versine;
    const double way_y_mm = along_y * sine + along_x * versine;
    place.turned_rad = turned_rad;
    place.x_mm += way_x_mm;
    place.y_mm += way_y_mm;
    place.cosine_mm += way_x_mm;
    place.sine_mm += way_y_mm;
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

Sample MotorFunction::at(double time_s) const {
    if (in_space_) {
        const Series series = series_in_space(time_s);
        return {series[0], series[1], 2 * series[2]};
    }
    Sample sample = smooth_[0].at(time_s);
    sample.position -= start_;
    return sample;
}

Series MotorFunction::series(double time_s) const {
    return in_space_ ? series_in_space(time_s) : plus(smooth_[0].series(time_s), -start_);
}

Series MotorFunction::series_in_space(double time_s) const {
    const Series x = smooth_[axis_x].series(time_s), y = smooth_[axis_y].series(time_s);
    const Series z = smooth_[axis_z].series(time_s);
    Series up = z;
    if (bed_) motion::add(up, lift(*cell_, plus(x, -cell_->x_mm), plus(y, -cell_->y_mm), z));
    if (tower_) motion::add(up, height(plus(x, -tower_->x_mm), plus(y, -tower_->y_mm)));
    up[0] -= start_;
    for (double& power : up) power *= steps_per_mm_;
    return up;
}

// The root of arm^2 - x^2 - y^2.
Series MotorFunction::height(const Series& x, const Series& y) const {
    const Series xx = product(x, x), yy = product(y, y);
    const double off_mm = std::sqrt(xx[0] + yy[0]);
    Series square;
    for (std::size_t i = 0; i < square.size(); ++i) square[i] = -(xx[i] + yy[i]);
    square[0] = std::max(std::numeric_limits<double>::min(),
                         (tower_->arm_mm - off_mm) * (tower_->arm_mm + off_mm));
    return root(square);
}

Sizes MotorFunction::sizes_of_height(const Sizes& x, const Sizes& y) const {
    Sizes square = product(x, x);
    motion::add(square, product(y, y));
    const double off_mm = std::sqrt(square[0]);
    const double height_mm =
        std::sqrt(std::max(0.0, (tower_->arm_mm - off_mm) * (tower_->arm_mm + off_mm)));
    return sizes_of_root(square, std::max(height_mm, least_height_share * tower_->arm_mm));
}

Sizes MotorFunction::sizes_in_space() const {
    std::array<Sizes, 3> own;
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = smooth_[i].bounds(duration_s_).sizes;
    const auto sizes = [&](std::size_t axis, double from_mm) {
        own[axis][0] =
            std::abs(smooth_[axis].at(0).position - from_mm) + own[axis][1] * duration_s_;
        return own[axis];
    };
    const Sizes z = sizes(axis_z, 0);
    Sizes up = z;
    if (bed_)
        motion::add(
            up, lift(sizes_of(*cell_), sizes(axis_x, cell_->x_mm), sizes(axis_y, cell_->y_mm), z));
    if (tower_)
        motion::add(up, sizes_of_height(sizes(axis_x, tower_->x_mm), sizes(axis_y, tower_->y_mm)));
    return up;
}

void MotorFunction::set_bounds() {
    if (in_space_) {
        const Sizes sizes = sizes_in_space();
        constexpr double factorial_of_3 = 6;
        most_jerk_ = factorial_of_3 * sizes[3] * std::abs(steps_per_mm_);
        least_jerk_ = -most_jerk_;
        left_out_ = sizes[6] * std::abs(steps_per_mm_);
        return;
    }
    const Bounds bounds = smooth_[0].bounds(duration_s_);
    least_jerk_ = bounds.least_jerk;
    most_jerk_ = bounds.most_jerk;
    left_out_ = bounds.sizes[6];
}

}  // namespace lyr::motion
