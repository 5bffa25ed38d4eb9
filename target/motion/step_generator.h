// From planned segments to the steps of all motors in order of time.
//
// A motor steps when its coordinate passes the half-way point between two microsteps, so that the count is
// always the nearest one. Those times are solved in closed form for each motor (motor_track.h) in small
// batches, and merged.
//
// Contract
//  1. At any time, |count - motor_coordinate(ideal position)| <= 1/2 microstep, for every motor, to
//     kGrazing_mm and half a nanosecond of motion.
//  2. A step's time is that of the ideal crossing to kTimeError_ns, at any length of print: counts are absolute
//     integers and the time of a segment's start is an exact sum, so nothing drifts.
//  3. Exactly at a half-way point the count stays as it is: a motor that comes to rest, or turns round,
//     within kGrazing_mm beyond a half-way point does not step there. Should it go on the same way later,
//     the step is made when that motion begins.
//  4. Events leave in order of time. Steps of several motors of one segment in the same nanosecond make one
//     event; a motor steps at most once in an event.
//  5. An event's directions are those of all motors in force from that event's steps on; a motor that does not step
//     keeps its last direction. Set-up time and pulse width are the consumer's.
//  6. No memory is allocated by read(). The same segments give the same events whatever the size of the
//     spans that are passed.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "target/motion/kinematics.h"
#include "target/motion/motor_track.h"
#include "target/motion/planner.h"

namespace lyr::motion {

struct StepEvent {
    std::int64_t time_ns;     // since the start of the print
    std::uint32_t tag;        // of the move
    std::uint8_t steps;       // bit m: motor m makes one microstep
    std::uint8_t directions;  // bit m: motor m's count grows
};

class StepGenerator {
public:
    explicit StepGenerator(const Kinematics& kinematics, const Position& start = {});

    // Takes segments from the planner as long as there are any and fills `events`; returns how many were
    // written. Less than events.size(): the planner has no settled segment left.
    std::size_t read(Planner& planner, std::span<StepEvent> events);

    // The same for a segment from elsewhere: begin() it when !busy(), then read until less than asked for.
    void begin(const PlannedSegment& segment);
    std::size_t read(std::span<StepEvent> events);
    bool busy() const { return busy_; }

    // The end of the segments begun so far; after the last read, the time of the print.
    std::int64_t time_ns() const { return end_ns_; }
    // After the steps read so far.
    const MotorCounts& counts() const { return counts_; }

    // Declares where the machine is, after homing. Requires !busy().
    void set_position(const Position& position);
    // Lets time pass at rest (heating, waiting for an operator). Requires !busy().
    void wait_until(std::int64_t at_ns);

private:
    void finish_segment();

    Kinematics kinematics_;
    std::array<MotorTrack, kMotors> tracks_;
    MotorCounts counts_{};
    std::uint8_t directions_ = 0;
    bool busy_ = false;
    std::uint32_t tag_ = 0;
    std::int64_t start_ns_ = 0;  // of the segment under way
    double start_rest_ns_ = 0;   // what the start lies beyond start_ns_, in [0, 1)
    std::int64_t end_ns_ = 0;
    double end_rest_ns_ = 0;
};

}  // namespace lyr::motion
