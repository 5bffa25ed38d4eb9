// One motor along one move: after which distance it steps next, and which way. Knows nothing of
// time.
//
// Method. The motor's function of distance is cut at its turning points; between them it only rises
// or only falls, and each middle between two microsteps that lies in its range is passed once.
// Solved from the begin of such a span, with t = tan(angle / 2) = change / (|sin| at the begin +
// |sin| at the end): no digits are lost at turning points nor on arcs that are nearly straight.
//
// Contract
//  1. Distances come in ascending order. Between two of them the ideal position is within half a
//     microstep (and touch_steps) of the count.
//  2. A middle that a span does not pass by touch_steps is not passed in this span; if the next
//     span goes on the same way, it is passed at its begin.

#pragma once

#include <cstdint>
#include <limits>

#include "target/motion/kinematics.h"

namespace lyr::motion {

class MotorWalk {
public:
    // Of the order of the rounding of a coordinate of 1 m at 5000 steps per mm.
    static constexpr double touch_steps = 1e-9;
    static constexpr double no_step_mm = std::numeric_limits<double>::infinity();

    // `count` is the microstep at which the motor stands.
    void start(const MotorPath& path, double length_mm, std::int64_t count);

    // Takes the next step and returns the distance at which it comes, or no_step_mm.
    double next_mm();
    // Of the step taken last: +1 or -1.
    int direction() const { return direction_; }
    std::int64_t count() const { return count_; }
    // Where the span ends, in steps; when there is no next step, where the move does.
    double end() const { return span_end_; }

private:
    void begin(const Linear& line);
    void begin(const Harmonic& turning);
    bool next_span();
    void measure_span();
    double distance_mm(double position) const;

    double length_mm_ = 0;
    std::int64_t count_ = 0;
    bool turns_ = false;
    int direction_ = 0;                     // in the span; 0: stands still
    double span_begin_ = 0, span_end_ = 0;  // in steps
    double mm_per_step_ = 0;                // of a linear motor
    // Of a turning motor.
    double amplitude_ = 0, mm_per_rad_ = 0, sweep_rad_ = 0;
    double begin_rad_ = 0;    // since the begin of the move
    double to_turn_rad_ = 0;  // from there to the turning point
    double sine_ = 0;         // its size at the begin of the span
    double heading_ = 0;      // the cosine there, as if the motor were falling
};

}  // namespace lyr::motion
