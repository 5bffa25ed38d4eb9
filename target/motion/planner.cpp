// Later moves can only raise what the ones before are allowed: the stop at the end moves away. So a
// speed that has gone out stays reachable, whatever is pushed after it.

#include "target/motion/planner.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/constants.h"

namespace lyr::motion {
namespace {

// Of the ring, that goes out at once when nothing in it is final: few passes over it per move.
constexpr std::size_t share_to_release = 4;

bool is_near(double value) {
    return std::abs(value) <= Planner::farthest_mm;  // false for what is not a number
}

bool is_near(const Point& point) {
    return is_near(point.x) && is_near(point.y) && is_near(point.z);
}

double distance_mm(const Point& a, const Point& b) {
    return std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
}

bool is_sound(const Line&, const Path&, double) {
    return true;
}

// At most a turn, and where its angles and radius lead to is its end.
bool is_sound(const Arc& arc, const Path& path, double length_mm) {
    return arc.radius_mm > 0 && std::abs(arc.start_angle_rad) <= 4 * std::numbers::pi &&
           std::abs(arc.sweep_rad) <= 2 * std::numbers::pi &&
           distance_mm(point_at(path, length_mm), arc.to) <= Planner::join_mm;
}

}  // namespace

Result<Planner> Planner::create(const Limits& limits, std::size_t capacity) {
    if (const Status sound = motion::check(limits); !sound) return sound.error();
    if (capacity < share_to_release)
        return machine_error("the planner's window must hold at least " +
                             std::to_string(share_to_release) + " moves");
    return Planner(limits, capacity);
}

Planner::Entry& Planner::at(std::size_t index) {
    const std::size_t place = first_ + index;
    return ring_[place < ring_.size() ? place : place - ring_.size()];
}

Status Planner::push(const Move& move) {
    const double length_mm = length_of(move.path);
    if (Status sound = check(move, length_mm); !sound) return sound;
    if (length_mm < shortest_mm) return Done{};
    Entry next;
    next.move = move;
    next.length_mm = length_mm;
    next.limits = limits_of(move, limits_);
    const bool is_extruder_alone = tangent_at(move.path, 0) == Point{};
    next.ramps_mm = is_extruder_alone ? length_mm : (1 - limits_.minimum_cruise_ratio) * length_mm;
    // An even ramp up and down takes no longer than twice this, the cruise between them counted in.
    const double ramp_s = length_mm / std::sqrt(next.limits.acceleration_mm_s2 * next.ramps_mm);
    if (!(length_mm / next.limits.speed_mm_s + 2 * ramp_s <= longest_s))
        return machine_error("a move would take longer than 11 days: its speed is too low");
    next.corner_mm2_s2 = next.junction_mm2_s2 = corner_mm2_s2(next);
    next.dwell_ns = dwell_ns_;

    ++size_;
    at(size_ - 1) = next;
    last_ = move;
    last_limits_ = next.limits;
    begun_ = true;
    rests_ = false;
    dwell_ns_ = 0;
    return Done{};
}

Status Planner::check(const Move& move, double length_mm) const {
    const Point &from = start_of(move.path), &to = end_of(move.path);
    if (full()) return machine_error("the planner's window is full");
    if (!is_near(from) || !is_near(to) || !is_near(advance_of(move.path)) || !is_near(length_mm))
        return machine_error("a move must stay within 100 m of the origin");
    if (!(move.speed_mm_s > 0) || !std::isfinite(move.speed_mm_s))
        return machine_error("a move's speed must be a positive number of mm/s");
    if (!(move.acceleration_mm_s2 >= 0))
        return machine_error("a move's acceleration must be 0 or a positive number of mm/s^2");
    const bool sound = std::visit(
        [&](const auto& shape) { return is_sound(shape, move.path, length_mm); }, move.path);
    if (!sound) return machine_error("an arc's centre, radius and angles do not lead to its end");
    if (begun_ && distance_mm(end_of(last_.path), from) > join_mm)
        return machine_error("a move must start where the move before ends");
    return Done{};
}

double Planner::corner_mm2_s2(const Entry& next) const {
    if (rests_) return 0;
    const double speed_mm_s = std::min({last_limits_.speed_mm_s, next.limits.speed_mm_s,
                                        corner_speed_mm_s(last_, next.move, limits_)});
    return speed_mm_s * speed_mm_s;
}

void Planner::dwell(double time_s) {
    rests_ = true;
    if (time_s > 0) dwell_ns_ += std::min(time_s, longest_s) * ns_per_s;
}

void Planner::flush() {
    rests_ = true;
    flushed_ = size_;
}

void Planner::settle() {
    constexpr Pass smoothed{&Entry::ramps_mm, &Entry::corner_mm2_s2, &Entry::smoothed_mm2_s2};
    constexpr Pass real{&Entry::length_mm, &Entry::junction_mm2_s2, &Entry::start_mm2_s2};
    std::size_t final = 0;
    if (has_ratio()) {
        (void)limit_backwards(smoothed);
        limit_forwards(smoothed);
        final = limit_peaks();
        (void)limit_backwards(real);
    } else {
        final = limit_backwards(real);
    }
    limit_forwards(real);
    settled_ = std::max({final, flushed_, full() ? size_ / share_to_release : 0});
}

// Returns how many moves at the front no later move can change: those before the last junction
// whose own limit is the tightest.
std::size_t Planner::limit_backwards(const Pass& pass) {
    std::size_t final = 0;
    double end_mm2_s2 = 0;
    for (std::size_t i = size_ - 1; i > 0; --i) {
        Entry& entry = at(i);
        const double most = entry.*pass.most_mm2_s2;
        const double reachable = reachable_mm2_s2(end_mm2_s2, entry.*pass.way_mm, entry.limits);
        if (final == 0 && most <= reachable) final = i;
        end_mm2_s2 = entry.*pass.start_mm2_s2 = std::min(most, reachable);
    }
    return final;
}

void Planner::limit_forwards(const Pass& pass) {
    for (std::size_t i = 0; i + 1 < size_; ++i) {
        const Entry& entry = at(i);
        double& end_mm2_s2 = at(i + 1).*pass.start_mm2_s2;
        end_mm2_s2 = std::min(end_mm2_s2, reachable_mm2_s2(entry.*pass.start_mm2_s2,
                                                           entry.*pass.way_mm, entry.limits));
    }
}

// Between two junctions that it passes at their own limit, the smoothed plan rises and falls once; the highest speed on the
// way is then the top of all its moves. Returns how many moves at the front no later move can change: those before
// the last such junction, for what comes before any other may still rise to more.
std::size_t Planner::limit_peaks() {
    std::size_t first = 0;
    double peak_mm2_s2 = gone_peak_mm2_s2_;
    for (std::size_t i = 0; i < size_; ++i) {
        const bool is_last = i + 1 == size_;
        peak_mm2_s2 = std::max(
            peak_mm2_s2, smoothed_peak_mm2_s2(at(i), is_last ? 0 : at(i + 1).smoothed_mm2_s2));
        if (!is_last && !is_slow_place(at(i + 1))) continue;
        for (std::size_t k = first; k <= i; ++k) {
            at(k).peak_mm2_s2 = peak_mm2_s2;
            at(k).junction_mm2_s2 = std::min(at(k).corner_mm2_s2, peak_mm2_s2);
        }
        if (is_last) break;
        first = i + 1;
        peak_mm2_s2 = 0;
    }
    return first;
}

double Planner::reachable_mm2_s2(double speed_mm2_s2, double way_mm,
                                 const MoveLimits& limits) const {
    if (!(limits_.jerk_mm_s3 > 0)) return speed_mm2_s2 + 2 * limits.acceleration_mm_s2 * way_mm;
    const double reached_mm_s = reachable_mm_s(std::sqrt(speed_mm2_s2), way_mm,
                                               {limits.acceleration_mm_s2, limits_.jerk_mm_s3});
    return reached_mm_s * reached_mm_s;
}

double Planner::smoothed_peak_mm2_s2(const Entry& entry, double end_mm2_s2) const {
    const auto [top_mm_s, acceleration_mm_s2] = entry.limits;
    const double v = std::sqrt(entry.smoothed_mm2_s2), w = std::sqrt(end_mm2_s2);
    const double peak_mm_s =
        limits_.jerk_mm_s3 > 0
            ? s_curve_peak_mm_s(entry.ramps_mm, v, w, top_mm_s,
                                {acceleration_mm_s2, limits_.jerk_mm_s3})
            : trapezoid_peak_mm_s(entry.ramps_mm, v, w, top_mm_s, acceleration_mm_s2);
    // Not below its ends by the rounding of a root.
    return std::max({peak_mm_s * peak_mm_s, entry.smoothed_mm2_s2, end_mm2_s2});
}

bool Planner::pop(PlannedMove& planned) {
    if (settled_ == 0) {
        if (flushed_ == 0 && !full()) return false;
        settle();
    }
    const Entry& entry = at(0);
    const double end_mm2_s2 = size_ > 1 ? at(1).start_mm2_s2 : 0;
    advance_ns(entry.dwell_ns);
    planned.path = entry.move.path;
    planned.tag = entry.move.tag;
    planned.start_ns = time_ns_;
    planned.start_part_ns = time_part_ns_;
    const double start_mm_s = std::sqrt(entry.start_mm2_s2), end_mm_s = std::sqrt(end_mm2_s2);
    const double acceleration_mm_s2 = entry.limits.acceleration_mm_s2;
    const double top_mm_s = has_ratio()
                                ? std::min(entry.limits.speed_mm_s, std::sqrt(entry.peak_mm2_s2))
                                : entry.limits.speed_mm_s;
    planned.profile =
        limits_.jerk_mm_s3 > 0
            ? s_curve(entry.length_mm, start_mm_s, end_mm_s, top_mm_s,
                      {acceleration_mm_s2, limits_.jerk_mm_s3})
            : trapezoid(entry.length_mm, start_mm_s, end_mm_s, top_mm_s, acceleration_mm_s2);
    advance_ns(planned.profile.duration_s * ns_per_s);
    gone_peak_mm2_s2_ = size_ > 1 && !is_slow_place(at(1)) ? entry.peak_mm2_s2 : 0;
    first_ = first_ + 1 < ring_.size() ? first_ + 1 : 0;
    --size_;
    --settled_;
    if (flushed_ > 0) --flushed_;
    return true;
}

void Planner::advance_ns(double time_ns) {
    const double sum_ns = time_part_ns_ + time_ns;
    const double whole_ns = std::floor(sum_ns);
    time_ns_ += static_cast<std::int64_t>(whole_ns);
    time_part_ns_ = sum_ns - whole_ns;
}

}  // namespace lyr::motion
