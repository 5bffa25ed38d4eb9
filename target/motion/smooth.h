// A function of time without breaks: a cubic and a few turns of arcs whose angles are cubics. What a
// machine's axis, or a sum of shifted copies of it, is while none of the copies changes its phase.
//
// Contract
//  1. Within |angle| <= largest_turn_rad position and derivatives are exact to rounding. Nothing is lost on arcs that are
//     nearly straight: a turn is kept as its way from where it begins.
//  2. leaves() is when the position first comes within `nearly` of one of two bounds it lies between, or the time given
//     if that is earlier. It may be early (a position that creeps along a bound), never late.
//  3. bounds() holds for all times from 0 to the one given, as long as no angle turns back.
//  4. series() is Taylor's about the time: it leaves out no more than the sizes of bounds() say, as long as those hold.

#pragma once

#include <array>
#include <cstddef>

#include "target/motion/series.h"

namespace lyr::motion {

struct Sample {
    double position = 0, speed = 0, acceleration = 0;
};

struct Bounds {
    Sizes sizes{};  // but for the position's
    double least_jerk = 0, most_jerk = 0;
};

// Without a constant: the angle since the begin.
struct TurnAngle {
    double rate = 0, half_acceleration = 0, sixth_jerk = 0;
};

struct Turn {
    TurnAngle angle;
    double ahead = 0;   // times the angle's sine
    double inward = 0;  // times 1 - its cosine
};

// 1 - cos() loses no digits.
struct SineVersine {
    double sine = 0, versine = 0;
};

class Smooth {
public:
    static constexpr double largest_turn_rad = 0.8;
    static constexpr std::size_t most_turns = 10;

    void clear() {
        c_ = {};
        turn_count_ = 0;
    }
    void add_cubic(double constant, double rate, double half_acceleration, double sixth_jerk) {
        c_[0] += constant;
        c_[1] += rate;
        c_[2] += half_acceleration;
        c_[3] += sixth_jerk;
    }
    void add_constant(double constant) { c_[0] += constant; }
    void add_turn(const Turn& turn) { turns_[turn_count_++] = turn; }

    Sample at(double time) const {
        Sample sample{c_[0] + time * (c_[1] + time * (c_[2] + time * c_[3])),
                      c_[1] + time * (2 * c_[2] + time * 3 * c_[3]), 2 * c_[2] + 6 * c_[3] * time};
        for (std::size_t i = 0; i < turn_count_; ++i) add(turns_[i], time, sample);
        return sample;
    }
    Series series(double time) const {
        Series series{c_[0] + time * (c_[1] + time * (c_[2] + time * c_[3])),
                      c_[1] + time * (2 * c_[2] + time * 3 * c_[3]),
                      c_[2] + 3 * c_[3] * time,
                      c_[3],
                      0,
                      0};
        for (std::size_t i = 0; i < turn_count_; ++i) add(turns_[i], time, series);
        return series;
    }
    Bounds bounds(double time) const;
    double leaves(double low, double high, double nearly, double time) const;
    // Of |angle| <= largest_turn_rad.
    static SineVersine turned(double angle);

private:
    static void add(const Turn& turn, double time, Sample& sample);
    static void add(const Turn& turn, double time, Series& series);

    std::array<double, 4> c_{};
    std::array<Turn, most_turns> turns_;
    std::size_t turn_count_ = 0;
};

}  // namespace lyr::motion
