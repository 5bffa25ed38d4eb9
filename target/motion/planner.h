// Look-ahead: finds for a run of moves the highest speeds from which the machine can still keep
// every limit that follows, up to a stop at the end of what it knows.
//
// Method. Speeds at the junctions are limited backwards (each move must be able to slow down to its
// end) and then forwards (each must be able to reach it), in squares, where even acceleration is a
// sum. Moves wait in a ring. When it is full, those go out whose speeds no later move can change,
// or else, to make room, a quarter of the ring with the speeds that are safe for certain.
// With a ratio of cruising the same is first done as if of every move only the rest of its length were there to
// change speed in. What is fastest in that plan between two slow places is the top speed between them in the real one.
//
// Contract
//  1. Planned moves come out in the order in which moves went in, each once. The first starts at
//     time 0 and each where the one before ends, or a dwell later, at the same speed. The last
//     before a flush or dwell ends at speed 0.
//  2. No planned move exceeds its MoveLimits, no junction its corner speed.
//     With a limit of jerk the acceleration never changes faster, and is 0 at every end of a move.
//  3. With fewer than `capacity` moves between flushes the plan is the fastest that keeps 2 and 7.
//     Otherwise each move is planned with at least three quarters of the capacity known beyond it.
//  4. Start times are whole nanoseconds plus a remainder that is carried along: the sum of a
//     print's moves does not depend on how often it was rounded.
//  5. Nothing is allocated after create().
//  6. A refused move (error) leaves the planner as it was.
//  7. With a ratio of cruising, a way from one stop to the next on which nothing else limits the speed is gone at an even
//     speed for that share of it: of one move, or without a limit of jerk of any number that go straight on. The
//     extruder alone is left as it is: nothing shakes.

#pragma once

#include <cstdint>
#include <vector>

#include "base/diagnostic.h"
#include "target/motion/limits.h"
#include "target/motion/profile.h"

namespace lyr::motion {

struct PlannedMove {
    Path path;
    Profile profile;
    std::int64_t start_ns = 0;
    double start_part_ns = 0;  // the start is this much later; 0..1
    std::uint32_t tag = 0;
};

class Planner {
public:
    // Enough to come to rest from 300 mm/s at 3000 mm/s^2 over moves of 20 um.
    static constexpr std::size_t default_capacity = 1024;
    // Moves that follow each other meet within this: far below a microstep, far above rounding.
    static constexpr double join_mm = 1e-6;
    // A coordinate within 100 m keeps its rounding far below a microstep, a duration within 11 days
    // below a nanosecond.
    static constexpr double farthest_mm = 1e5;
    static constexpr double longest_s = 1e6;
    // Below the rounding of any coordinate; a move shorter than this is none.
    static constexpr double shortest_mm = 1e-12;

    // Error (status machine): limits that are not positive, or a capacity below 4.
    static Result<Planner> create(const Limits& limits, std::size_t capacity = default_capacity);

    // A full planner takes no more; pop() makes room.
    bool full() const { return size_ == ring_.size(); }
    // Errors (status machine): not finite, too far or too long, a speed that is not positive, an
    // arc that does not lead to its end, a start that is not the end of the move before, a full
    // planner. A move shorter than shortest_mm is taken and left out.
    Status push(const Move& move);
    // The moves pushed so far end at rest, and those that follow begin so much later, at most
    // longest_s; a time that is not positive is no wait, only a stop.
    void dwell(double time_s);
    // What was pushed so far ends at rest, and pop() gives all of it.
    void flush();

    // The next planned move, if there is one whose speeds are settled. False: push more, or flush.
    bool pop(PlannedMove& planned);

    // Where the last move that was popped ends.
    std::int64_t time_ns() const { return time_ns_; }

private:
    struct Entry {
        Move move;
        double length_mm = 0;
        double ramps_mm = 0;  // of its length, what is there to change speed in
        MoveLimits limits;
        double corner_mm2_s2 = 0;    // largest squared speed at its start
        double smoothed_mm2_s2 = 0;  // planned there over ramps_mm
        double peak_mm2_s2 = 0;      // the largest of that plan from one slow place to the next
        double junction_mm2_s2 = 0;  // corner_mm2_s2 within the peaks
        double start_mm2_s2 = 0;     // planned
        double dwell_ns = 0;         // before it
    };
    // What a look-ahead reads of each move, and writes.
    struct Pass {
        double Entry::*way_mm;
        double Entry::*most_mm2_s2;
        double Entry::*start_mm2_s2;
    };

    Planner(const Limits& limits, std::size_t capacity) : limits_(limits), ring_(capacity) {}
    Entry& at(std::size_t index);
    Status check(const Move& move, double length_mm) const;
    double corner_mm2_s2(const Entry& next) const;
    bool has_ratio() const { return limits_.minimum_cruise_ratio > 0; }
    void settle();
    std::size_t limit_backwards(const Pass& pass);
    void limit_forwards(const Pass& pass);
    std::size_t limit_peaks();
    bool is_slow_place(const Entry& entry) const {
        return entry.smoothed_mm2_s2 == entry.corner_mm2_s2;
    }
    // The largest squared speed at the other end of a way, from this one at one end.
    double reachable_mm2_s2(double speed_mm2_s2, double way_mm, const MoveLimits& limits) const;
    double smoothed_peak_mm2_s2(const Entry& entry, double end_mm2_s2) const;
    void advance_ns(double time_ns);

    Limits limits_;
    std::vector<Entry> ring_;
    std::size_t first_ = 0, size_ = 0;
    std::size_t settled_ = 0;  // moves at the front that may go out
    std::size_t flushed_ = 0;  // moves at the front that must
    // Of moves that are gone, on the way to the first slow place in the ring.
    double gone_peak_mm2_s2_ = 0;
    bool begun_ = false;  // `last_` and its limits are those of a move
    Move last_;
    MoveLimits last_limits_;
    bool rests_ = true;  // before the next move
    double dwell_ns_ = 0;
    std::int64_t time_ns_ = 0;
    double time_part_ns_ = 0;
};

}  // namespace lyr::motion
