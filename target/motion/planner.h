// Look-ahead: finds for a run of moves the highest speeds from which the machine can still keep every
// limit that follows, up to a stop at the end of what it knows.
//
// Method. Speeds at the junctions are limited backwards (each move must be able to slow down to its end)
// and then forwards (each must be able to reach it), in squares, where even acceleration is a sum. Moves
// wait in a ring. When it is full, those go out whose speeds no later move can change, or else, to make
// room, a quarter of the ring with the speeds that are safe for certain.
//
// Contract
//  1. Planned moves come out in the order in which moves went in, each once. The first starts at time 0
//     and each where the one before ends, at the same speed. The last before a flush or dwell ends at 0.
//  2. No planned move exceeds its MoveLimits, no junction its corner speed.
//  3. With fewer than `capacity` moves between flushes the plan is the fastest that keeps 2. Otherwise
//     each move is planned with at least three quarters of the capacity known beyond it.
//  4. Start times are whole nanoseconds plus a remainder that is carried along: the sum of a print's
//     moves does not depend on how often it was rounded.
//  5. Nothing is allocated after create().
//  6. A refused move (error) leaves the planner as it was.

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

    // Error (status machine): limits that are not positive, or a capacity below 4.
    static Result<Planner> create(const Limits& limits, std::size_t capacity = default_capacity);

    // A full planner takes no more; pop() makes room.
    bool full() const { return size_ == ring_.size(); }
    // Errors (status machine): not finite, a speed that is not positive, a start that is not the end of
    // the move before, a full planner. A move of no length is taken and left out.
    Status push(const Move& move);
    // The machine rests for this time between the moves pushed so far and those that follow.
    void dwell(double time_s);
    // What was pushed so far ends at rest, and pop() gives all of it.
    void flush() { flushing_ = size_ > 0; }

    // The next planned move, if there is one whose speeds are settled. False: push more, or flush.
    bool pop(PlannedMove& planned);

    // Where the last move that was popped ends, or a later dwell.
    std::int64_t time_ns() const { return time_ns_; }

private:
    struct Entry {
        Move move;
        double length_mm;
        MoveLimits limits;
        double junction_mm2_s2;  // largest squared speed at its start
        double start_mm2_s2;     // planned
        double dwell_ns;         // before it
    };

    Planner(const Limits& limits, std::size_t capacity) : limits_(limits), ring_(capacity) {}
    Entry& at(std::size_t index) { return ring_[(first_ + index) % ring_.size()]; }
    Status check(const Move& move) const;
    void settle();
    void advance_ns(double time_ns);

    Limits limits_;
    std::vector<Entry> ring_;
    std::size_t first_ = 0, size_ = 0;
    std::size_t settled_ = 0;  // moves at the front that may go out
    bool flushing_ = false;
    bool any_ = false;  // a move was pushed ever
    Move last_;
    double dwell_ns_ = 0;  // before the next move
    bool rests_ = true;    // before the next move
    double next_start_mm2_s2_ = 0;  // of the move behind the settled ones
    std::int64_t time_ns_ = 0;
    double time_part_ns_ = 0;
};

}  // namespace lyr::motion
