// The plan along one channel, a little earlier or later and times a weight: one term of the sums that shaping is.
// Evaluated forwards, from a time over the distance to a place, where the generators solve backwards; it shares the
// speed profile and the paths with them, and no other code.
//
// Method. It remembers the stretch of the plan in which it was asked last: a phase of a move's profile, on an arc
// at most largest_turn_rad of it to either side, or a rest. There it is a cubic in time, or a turn by a cubic angle.
// A sum remembers one polynomial for all its terms: of a turn, Taylor's about the time at which it was asked first.
//
// Contract
//  1. at_mm() of a copy is exact to rounding for all times from the begin of the first piece to the end of the last;
//     before it is where the first begins, after it where the last ends.
//  2. Times may come in any order; ascending ones are quick. A sum is that of its terms, within series_mm for each.

#pragma once

#include <cmath>
#include <deque>
#include <vector>

#include "target/motion/planner.h"
#include "target/motion/tap.h"

namespace lyr::run {

// A move of the plan, and what was fed and laid down before it.
struct PlanPiece {
    motion::PlannedMove move;
    double fed_mm = 0, pressed_mm = 0;
    bool presses = false;
};
using PlanPieces = std::deque<PlanPiece>;

// Millimetres by powers of the nanoseconds since some time.
using Series = std::array<double, 6>;
inline constexpr double series_mm = 1e-7;

inline double value_of(const Series& c, double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

class PlanCopy {
public:
    PlanCopy(std::size_t channel, double weight, std::int64_t offset_ns)
        : channel_(channel), weight_(weight), offset_ns_(offset_ns) {}

    std::int64_t offset_ns() const { return offset_ns_; }

    double at_mm(const PlanPieces& pieces, std::int64_t plan_ns) {
        const std::int64_t at_ns = plan_ns + offset_ns_;
        if (at_ns < begin_ns_ || at_ns >= end_ns_) seek(pieces, at_ns);
        double value = cubic(at_ns);
        if (!turns_) return value;
        if (std::abs(value) > largest_turn_rad) {
            seek(pieces, at_ns);
            value = cubic(at_ns);
        }
        return turned_mm(value);
    }

    // After at_mm() of that time: adds its series about it, and says until when that holds.
    std::int64_t add_to(Series& c, std::int64_t plan_ns) const;

private:
    static constexpr double largest_turn_rad = 0.25;

    double cubic(std::int64_t at_ns) const {
        const double t = static_cast<double>(at_ns - origin_ns_) - origin_part_ns_;
        return c_[0] + t * (c_[1] + t * (c_[2] + t * c_[3]));
    }
    struct Turned {
        double sine, versine;
    };
    // The first terms left out are 0.25^11 / 11! = 6e-15 of the radius and less.
    static Turned turned(double a) {
        const double q = a * a, q2 = q * q;
        return {a * ((1 - q * (1. / 6)) + q2 * ((1. / 120 - q * (1. / 5040)) + q2 * (1. / 362880))),
                q * ((1. / 2 - q * (1. / 24)) +
                     q2 * ((1. / 720 - q * (1. / 40320)) + q2 * (1. / 3628800)))};
    }
    double turned_mm(double a) const {
        const auto [sine, versine] = turned(a);
        return place_mm_ + ahead_mm_ * sine + inward_mm_ * versine;
    }
    double reach_ns(double a1, double a2, double a3) const;
    // The stretch from here on.
    void seek(const PlanPieces& pieces, std::int64_t at_ns);
    void begin_phase(const PlanPiece& piece, std::int64_t at_ns);
    void begin_turn(const motion::Arc& arc, double share, double place_mm);

    std::size_t channel_;
    double weight_;
    std::int64_t offset_ns_;
    // Of the stretch; at first there is none.
    std::int64_t begin_ns_ = 0, end_ns_ = 0;
    std::int64_t origin_ns_ = 0;  // from here on, and a part, the cubic counts nanoseconds
    double origin_part_ns_ = 0;
    std::array<double, 4> c_{};  // mm, or of a turn rad from its begin
    bool turns_ = false;
    double place_mm_ = 0, ahead_mm_ = 0, inward_mm_ = 0;  // of a turn
    double reach_rad_ = 0;                                // of its series
};

class PlanSum {
public:
    explicit PlanSum(std::vector<PlanCopy> copies) : copies_(std::move(copies)) {}

    double at_mm(const PlanPieces& pieces, std::int64_t plan_ns) {
        if (plan_ns < begin_ns_ || plan_ns >= end_ns_) return sought_mm(pieces, plan_ns);
        const auto t = static_cast<double>(plan_ns - begin_ns_);
        return value_of(c_, t);
    }
    // Adds its series about that time, times `share`, and says until when that holds.
    std::int64_t add_to(Series& c, double share, const PlanPieces& pieces, std::int64_t plan_ns);

private:
    double sought_mm(const PlanPieces& pieces, std::int64_t plan_ns);

    std::vector<PlanCopy> copies_;
    std::int64_t begin_ns_ = 0, end_ns_ = 0;
    Series c_{};
};

}  // namespace lyr::run
