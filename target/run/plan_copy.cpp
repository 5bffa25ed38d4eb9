// Stretches are made of whole nanoseconds: all those that lie in a phase.

#include "target/run/plan_copy.h"

#include <algorithm>
#include <limits>

#include "base/constants.h"

namespace lyr::run {
namespace {

// The first whole nanosecond that is not before a time since the begin of the move.
std::int64_t first_ns(const motion::PlannedMove& move, double since_s) {
    return move.start_ns +
           static_cast<std::int64_t>(std::ceil(move.start_part_ns + since_s * ns_per_s));
}

double coordinate(const motion::Point& at, std::size_t axis) {
    return axis == motion::axis_x ? at.x : axis == motion::axis_y ? at.y : at.z;
}

// What a channel gains over the whole move.
double gain_mm(const PlanPiece& piece, std::size_t channel) {
    const motion::Path& path = piece.move.path;
    if (channel == motion::pressed_channel && !piece.presses) return 0;
    if (channel >= motion::axis_e) return motion::advance_of(path);
    return coordinate(motion::end_of(path), channel) - coordinate(motion::start_of(path), channel);
}

double place_mm(const PlanPiece& piece, std::size_t channel, double share) {
    if (channel < motion::axis_e)
        return coordinate(motion::point_at_share(piece.move.path, share), channel);
    const double from_mm = channel == motion::axis_e ? piece.fed_mm : piece.pressed_mm;
    return from_mm + gain_mm(piece, channel) * share;
}

}  // namespace

void PlanCopy::seek(const PlanPieces& pieces, std::int64_t at_ns) {
    const auto after = std::upper_bound(pieces.begin(), pieces.end(), at_ns,
                                        [](std::int64_t time_ns, const PlanPiece& piece) {
                                            return time_ns < first_ns(piece.move, 0);
                                        });
    const bool is_before_all = after == pieces.begin();
    const PlanPiece& piece = is_before_all ? *after : *std::prev(after);
    begin_ns_ = at_ns;
    if (!is_before_all && at_ns < first_ns(piece.move, piece.move.profile.duration_s))
        return begin_phase(piece, at_ns);
    // What follows the last piece is not known yet, and looked for each time.
    end_ns_ = after == pieces.end() ? at_ns : first_ns(after->move, 0);
    turns_ = false;
    c_ = {weight_ * place_mm(piece, channel_, is_before_all ? 0 : 1), 0, 0, 0};
}

void PlanCopy::begin_phase(const PlanPiece& piece, std::int64_t at_ns) {
    const motion::PlannedMove& move = piece.move;
    const motion::Profile& profile = move.profile;
    const auto ends_ns = [&](std::size_t phase) {
        const bool is_last = phase + 1 == profile.phases.size();
        return first_ns(move, is_last ? profile.duration_s : profile.phases[phase + 1].time_s);
    };
    std::size_t index = 0;
    while (ends_ns(index) <= at_ns) ++index;
    const motion::Phase& phase = profile.phases[index];
    end_ns_ = ends_ns(index);
    origin_ns_ = move.start_ns;
    origin_part_ns_ = move.start_part_ns + phase.time_s * ns_per_s;
    const double from_mm = phase.distance_mm, length_mm = profile.length_mm;
    constexpr double s_per_ns = 1 / ns_per_s;
    c_ = {0, phase.speed_mm_s * s_per_ns, phase.acceleration_mm_s2 / 2 * s_per_ns * s_per_ns,
          phase.jerk_mm_s3 / 6 * s_per_ns * s_per_ns * s_per_ns};
    const auto* arc = std::get_if<motion::Arc>(&move.path);
    turns_ = arc && channel_ <= motion::axis_y;
    double per_mm = weight_ * gain_mm(piece, channel_) / length_mm;
    if (turns_) {
        const double way_mm = cubic(at_ns), share = (from_mm + way_mm) / length_mm;
        begin_turn(*arc, share, weight_ * place_mm(piece, channel_, share));
        c_[0] = -way_mm;
        per_mm = arc->sweep_rad / length_mm;
    }
    for (double& c : c_) c *= per_mm;
    if (!turns_) c_[0] = weight_ * place_mm(piece, channel_, from_mm / length_mm);
}

void PlanCopy::begin_turn(const motion::Arc& arc, double share, double place_mm) {
    const double angle_rad = arc.start_angle_rad + share * arc.sweep_rad;
    const double sine_mm = weight_ * arc.radius_mm * std::sin(angle_rad);
    const double cosine_mm = weight_ * arc.radius_mm * std::cos(angle_rad);
    const bool is_x = channel_ == motion::axis_x;
    place_mm_ = place_mm;
    ahead_mm_ = is_x ? -sine_mm : cosine_mm;
    inward_mm_ = is_x ? -cosine_mm : -sine_mm;
    reach_rad_ = std::cbrt(std::sqrt(36 * series_mm / std::abs(weight_ * arc.radius_mm)));
}

// How long the series of a turn holds. Its error is below r h^6 / 720 times the largest sixth derivative of a sine of the
// angle, which is below (|a'| + 1.57 sqrt|a''| + 1.47 cbrt|a'''|)^6 by the formula of Faa di Bruno. That grows by a factor
// of 17 at most within the reach, where it is below 0.3 rad; 20 times 36 is 720.
double PlanCopy::reach_ns(double a1, double a2, double a3) const {
    constexpr double largest_reach_rad = 0.3;
    const double rate =
        std::abs(a1) + 1.57 * std::sqrt(2 * std::abs(a2)) + 1.47 * std::cbrt(6 * std::abs(a3));
    return std::min(reach_rad_, largest_reach_rad) / rate;
}

std::int64_t PlanCopy::add_to(Series& c, std::int64_t plan_ns) const {
    const double d = static_cast<double>(plan_ns + offset_ns_ - origin_ns_) - origin_part_ns_;
    const double a0 = c_[0] + d * (c_[1] + d * (c_[2] + d * c_[3]));
    const double a1 = c_[1] + d * (2 * c_[2] + d * 3 * c_[3]);
    const double a2 = c_[2] + d * 3 * c_[3], a3 = c_[3];
    if (!turns_) {
        c[0] += a0, c[1] += a1, c[2] += a2, c[3] += a3;
        return end_ns_ - offset_ns_;
    }
    // The turn from here on, about this place.
    const auto [sine, versine] = turned(a0);
    const double cosine = 1 - versine;
    const double ahead_mm = ahead_mm_ * cosine + inward_mm_ * sine;
    const double inward_mm = inward_mm_ * cosine - ahead_mm_ * sine;
    const double a11 = a1 * a1, a12 = a1 * a2, a13 = a1 * a3;
    c[0] += place_mm_ + ahead_mm_ * sine + inward_mm_ * versine;
    c[1] += ahead_mm * a1;
    c[2] += ahead_mm * a2 + inward_mm * (a11 / 2);
    c[3] += ahead_mm * (a3 - a11 * a1 / 6) + inward_mm * a12;
    c[4] += ahead_mm * (-a11 * a2 / 2) + inward_mm * (a2 * a2 / 2 + a13 - a11 * a11 / 24);
    c[5] += ahead_mm * (a11 * a11 * a1 / 120 - (a12 * a2 + a13 * a1) / 2) +
            inward_mm * (a2 * a3 - a11 * a12 / 6);
    const double left_ns = static_cast<double>(end_ns_ - offset_ns_ - plan_ns);
    return plan_ns + static_cast<std::int64_t>(std::min(left_ns, reach_ns(a1, a2, a3)));
}

// By Horner's rule once for each power.
std::int64_t PlanSum::add_to(Series& c, double share, const PlanPieces& pieces,
                             std::int64_t plan_ns) {
    if (plan_ns < begin_ns_ || plan_ns >= end_ns_) sought_mm(pieces, plan_ns);
    Series here = c_;
    const auto since_ns = static_cast<double>(plan_ns - begin_ns_);
    for (std::size_t i = 0; i + 1 < here.size(); ++i)
        for (std::size_t k = here.size() - 1; k-- > i;) here[k] += since_ns * here[k + 1];
    for (std::size_t i = 0; i < here.size(); ++i) c[i] += share * here[i];
    return end_ns_;
}

double PlanSum::sought_mm(const PlanPieces& pieces, std::int64_t plan_ns) {
    double sum_mm = 0;
    begin_ns_ = plan_ns;
    end_ns_ = std::numeric_limits<std::int64_t>::max();
    c_ = {};
    for (PlanCopy& copy : copies_) {
        sum_mm += copy.at_mm(pieces, plan_ns);
        end_ns_ = std::min(end_ns_, copy.add_to(c_, plan_ns));
    }
    return sum_mm;
}

}  // namespace lyr::run
