// One motor along one piece of time: when it steps next, and which way.
//
// Method. With bounds of the third derivative, of size J, a stretch of length h is decided when
//   both ends go the same way, faster than J h^2 / 8: the speed cannot vanish between them; or when
//   the acceleration keeps its sign, by its values at the ends and the bounds: there is at most one
//   turning point, which is looked for.
// Otherwise it is halved. On a stretch that only rises or only falls each middle between two steps is
// passed once. Its time is the root of the function's series about the point looked at last, by Newton's steps from that of
// the parabola; where what the series leaves out would be too much, a new point is looked at. Many middles are solved together:
// the first guess is then the cubic through the time and the speed at both ends of them, and one step of Newton's is
// enough, or they are fewer.
//
// Contract
//  1. Times come in ascending order, within exact_s of the root of the function.
//  2. A middle that a stretch does not pass by touch_steps is not passed in it.
//  3. With play the motor's position is that of the function plus what it is ahead. The function's play is
//     made up for within steps / eagerness of each turn.

#pragma once

#include <array>
#include <limits>
#include <span>

#include "target/motion/motor_function.h"

namespace lyr::motion {

// What a motor turns in vain when it turns back: the play of its screw or belt. The motor runs ahead by it
// while the axis rises, and by nothing while it falls; after a turn it gains `eagerness` times what the axis
// moves until that is made up for.
struct Play {
    static constexpr double eagerness = 4;
    double steps = 0;
    double ahead = 0;  // of the axis now; 0 as after a motion downwards

    // How far behind the axis may be meanwhile: until the motor has turned by the play.
    static double lag(double steps) { return steps / (1 + eagerness); }
};

class TimeWalk {
public:
    // Above the rounding of a sum of copies at 1e5 steps, far below what a motor can show.
    static constexpr double touch_steps = 1e-8;
    static constexpr double exact_s = 1e-10;

    explicit TimeWalk(double play_steps = 0) : play_{play_steps} {}

    // A new piece of the function; the motor stands at `count`.
    void start(const MotorFunction& function, std::int64_t count);

    // Takes the next steps, all the same way, and returns their times since the begin of the piece, which are valid until
    // the next call; none: it ends.
    std::span<const double> next_s(const MotorFunction& function);
    static constexpr int most_steps = 32;
    // Of the steps taken last: +1 or -1.
    int direction() const { return direction_; }

private:
    bool next_stretch(const MotorFunction& function);
    void take_up();
    // Where the function is when the motor passes a middle, and the other way round.
    double function_at(double middle) const;
    double motor_at(double position) const;
    bool keeps_sign(const Sample& low, const Sample& high, double h) const;
    double turning_s(const MotorFunction& function, const Sample& low, const Sample& high) const;
    void look(const MotorFunction& function, double time_s);
    // The times of how many steps from this middle on are found; 0: the next one has to be looked for alone.
    int find_ahead(const MotorFunction& function, double middle);
    // Since the point looked at last.
    struct Root {
        double time_s = 0, speed = 0;
        bool is_exact = false;
    };
    Root root(double middle) const;
    // From the step before until the last one of these. False: not exact.
    bool fill(double middle, int count, const Root& last);
    double solve_s(const MotorFunction& function, double middle);

    Play play_;
    double begin_ = 0;  // of the stretch, where play_.ahead is what it was
    std::int64_t count_ = 0;
    double duration_s_ = 0, least_jerk_ = 0, most_jerk_ = 0, jerk_ = 0;
    double left_out_ = 0;               // of a series, by the sixth power of the time
    int direction_ = 0;                 // in the stretch; 0: stands still
    double low_s_ = 0, high_s_ = 0;     // of the stretch
    double end_ = 0;                    // its position there
    double seen_s_ = 0, passed_s_ = 0;  // of the last point looked at, of the last step
    Series seen_{};                     // about the former
    Sample high_, last_;                // at the ends of the stretch and of the piece
    std::array<double, most_steps> found_s_;
    int ahead_ = most_steps;  // how many to look for next time
};

}  // namespace lyr::motion
