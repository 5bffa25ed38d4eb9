// Look-ahead over a bounded window of moves: how fast each may begin, run and end.
//
// Every move is capped by what its own path allows (move_limits.h) and every corner by the change of
// direction there. On a push, one backward pass over the tail whose speeds are still open raises the speeds
// from which the machine can stop at the end of what it knows; when a move leaves, its speed at the end
// follows from its start and from the next one's cap. Neither pass ever looks at a move whose speed is settled.
//
// Contract
//  1. No planned speed, acceleration or speed jump exceeds a limit; each segment starts at exactly the speed
//     at which the one before ended, and the last one before a stop ends at zero.
//  2. For the moves that were known when a segment left (at most `window`), no trapezoid profile is faster.
//  3. Which segments come out does not depend on when they are taken, as long as they are taken whenever
//     full() is true.
//  4. Whatever is pushed, it is planned to stop at the end of what is known.
//  5. A tangent-continuous junction is not slowed; a reversal is a stop; a move of the extruder alone begins
//     and ends with a stop, unless it continues another one in the same direction.
//  6. No memory is allocated after construction, except for the text of an error.
//
// Typical use, with a StepGenerator downstream:
//     while (planner.full()) drain();               // StepGenerator::read takes segments
//     if (Status s = planner.push(move); !s) return s.error();
//     ... at the end, or whenever the source of moves runs dry:   planner.flush(); drain();

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/diagnostic.h"
#include "target/motion/limits.h"
#include "target/motion/path.h"
#include "target/motion/profile.h"

namespace lyr::motion {

struct Move {
    Path path;
    double speed_mm_s = 0;  // asked for along the path; of the extruder where nothing else moves
    double acceleration_mm_s2 =
        std::numeric_limits<double>::infinity();  // a lower one than the machine's
    bool stop_at_end = false;
    std::uint32_t tag = 0;  // comes back with every step of this move
};

struct Dwell {
    double duration_s = 0;  // at rest
    std::uint32_t tag = 0;
};

struct PlannedSegment {
    Path path;
    Profile profile;
    std::uint32_t tag = 0;
};

class Planner {
public:
    static constexpr std::size_t kDefaultWindow = 256;

    // `window` of at least 2.
    explicit Planner(const Limits& limits, const Position& start = {},
                     std::size_t window = kDefaultWindow);

    // The move must start where the last one ended (position()). One of no length is accepted and leaves
    // nothing but its stop. Errors (status internal): full(), a gap. (status input): numbers out of range.
    // Nothing is changed by an error.
    Status push(const Move& move);
    Status push(const Dwell& dwell);

    // The machine comes to rest at the end of what was pushed; everything may now be taken.
    void flush();

    // The oldest segment, if its speeds are settled or the window is full.
    bool pop(PlannedSegment& segment);

    bool full() const { return count_ == ring_.size(); }
    bool empty() const { return count_ == 0; }
    std::size_t size() const { return count_; }
    const Position& position() const { return position_; }  // the end of what was pushed
    const Limits& limits() const { return limits_; }

    // Limits for the moves pushed from now on.
    void set_limits(const Limits& limits) { limits_ = limits; }
    // Declares where the machine is, after homing. Requires empty().
    void set_position(const Position& position);

private:
    struct Entry {
        Path path;
        double length_mm;
        double top_speed_sq;
        double acceleration_mm_s2;
        double start_cap_sq;    // of the corner at its start
        double start_speed_sq;  // from which it is possible to stop at the end of what is known
        bool settled;           // start_speed_sq will not rise any more
        double dwell_s;         // at rest at the start of this entry, instead of a path
        std::uint32_t tag;
    };

    Entry& entry(std::size_t index) { return ring_[(head_ + index) % ring_.size()]; }
    void append(const Entry& added);
    void raise_start_speeds();

    Limits limits_;
    std::vector<Entry> ring_;
    std::size_t head_ = 0, count_ = 0;
    Position position_;
    double head_speed_sq_ = 0;  // at which the oldest entry starts, or the machine moves at the end
    bool stop_at_tail_ = true;  // the next move starts from rest
    // Of the newest entry, for the corner to the next.
    Rates tail_rates_{};
    double tail_length_mm_ = 0, tail_acceleration_ = 0, tail_top_speed_sq_ = 0;
};

}  // namespace lyr::motion
