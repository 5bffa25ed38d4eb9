// One motor along one piece of time: when it steps next, and which way.
//
// Method. With bounds of the third derivative, of size J, a stretch of length h is decided when
//   both ends go the same way, faster than J h^2 / 8: the speed cannot vanish between them; or when
//   the acceleration keeps its sign, by its values at the ends and the bounds: there is at most one
//   turning point, which is looked for.
// Otherwise it is halved. On a stretch that only rises or only falls each middle between two steps is
// passed once. Its time is the root of the parabola through the last point looked at, off by less than
// J t^3 / (6 speed); where that is too much, a step of Newton's from there to the root of the cubic, off by what that
// step leaves and by S t^4 / (24 speed), S being a bound of the fourth derivative. Where that is too much as well, a new
// point is looked at. All these bounds grow with t, so where they hold for one step they hold for those before it:
// several are found together.
//
// Contract
//  1. Times come in ascending order, within exact_s of the root of the function.
//  2. A middle that a stretch does not pass by touch_steps is not passed in it.
//  3. With play the motor's position is that of the function plus what it is ahead. The function's play is
//     made up for within steps / eagerness of each turn.

#pragma once

#include <array>
#include <limits>

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
    static constexpr double no_step_s = std::numeric_limits<double>::infinity();

    explicit TimeWalk(double play_steps = 0) : play_{play_steps} {}

    // A new piece of the function; the motor stands at `count`.
    void start(const MotorFunction& function, std::int64_t count);

    // Takes the next step and returns its time since the begin of the piece, or no_step_s.
    double next_s(const MotorFunction& function);
    // Of the step taken last: +1 or -1.
    int direction() const { return direction_; }

private:
    bool next_stretch(const MotorFunction& function);
    void take_up();
    // Where the function is when the motor passes a middle, and the other way round.
    double function_at(double middle) const;
    double motor_at(double position) const;
    bool keeps_sign(const Sample& low, const Sample& high, double h) const;
    double turning_s(const MotorFunction& function, const Sample& high) const;
    // The times of some steps from this middle on, or false: the next one has to be looked for alone.
    bool find_ahead(const MotorFunction& function, double middle);
    std::size_t exact_count(double middle, std::size_t most) const;
    void fill(double middle, std::size_t count);
    // How long after the point looked at last the motor is so many steps further.
    struct Root {
        double change_s;
        bool is_exact;
    };
    Root root(double way) const;
    double solve_s(const MotorFunction& function, double middle);

    Play play_;
    double begin_ = 0;  // of the stretch, where play_.ahead is what it was
    std::int64_t count_ = 0;
    double duration_s_ = 0, least_jerk_ = 0, most_jerk_ = 0, jerk_ = 0, snap_ = 0;
    int direction_ = 0;                 // in the stretch; 0: stands still
    double low_s_ = 0, high_s_ = 0;     // of the stretch
    double end_ = 0;                    // its position there
    double seen_s_ = 0, passed_s_ = 0;  // of the last point looked at, of the last step
    Sample seen_, last_;                // there, and at the end of the piece
    Sample high_;
    // Found ahead and not given yet, and how many to look for next time.
    static constexpr std::size_t few_ahead = 4, most_ahead = 16;
    std::array<double, most_ahead> found_s_;
    std::size_t given_ = 0, found_ = 0, ahead_ = few_ahead;
};

}  // namespace lyr::motion
