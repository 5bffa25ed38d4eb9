// Lays the staircase of positions that the pulses make over the curves of the file, and measures how
// far apart they get. Time plays no part in it: this judges the shape that is drawn, on all axes, the
// extruder included, and shares no code with the planner.
//
// Method. While the staircase stands at a lattice position, the curve should run within half a step of
// it on every axis, until it passes the middle to the next position; there the staircase steps. So for
// each step the curve is followed from where it was left to the first point at which the stepping axis
// passes the middle, and the distances met on the way, turning points of arcs included, are the
// deviation. The curve is only ever followed forwards, so that order and direction are judged too.
//
// Where a curve only touches a middle, or runs along it, the step may be due there or at a later touch
// or passing, and only what follows can tell: each of these readings is followed, and the best counts.
// Readings that have come to the same place are one; those that a better one leaves behind end.
//
// Contract
//  1. The deviation of an axis is the largest distance, in its steps, between the position and the point
//     of the curve that belongs to it, at every step and between steps. A perfect train of pulses
//     deviates by exactly half a step.
//  2. Steps that are missing, too many, of the wrong axis or direction, or in an order that no motion
//     along the curve gives, show as a deviation of more than half a step.
//  3. Steps of the same point of the curve may come in either order. A curve that turns back within
//     `touch_steps` of a middle may be stepped to or not, each time that it does.
//  4. Once the deviation exceeds `lost_steps`, following ends; lost() tells.

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <vector>

#include "base/diagnostic.h"
#include "target/run/pulse_decoder.h"

namespace lyr::run {

using AxisValues = std::array<double, config::axis_count>;

// Of a distance that is kept if it is the largest: what is not a number must show, whatever is measured later.
inline double shown(double distance) {
    return std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
}

// A piece of the file's path: straight on all axes, or an arc in x and y (z and e then even along it).
struct PathCurve {
    AxisValues from_mm{}, to_mm{};
    bool is_arc = false;
    double center_x_mm = 0, center_y_mm = 0, radius_mm = 0;
    double start_angle_rad = 0, sweep_rad = 0;  // counter-clockwise positive
    std::uint32_t layer = 0;

    // At a share of its length, 0..1.
    AxisValues at(double share) const;
};

// The next piece, or false at the end of the file.
using CurveSource = std::function<Result<bool>(PathCurve&)>;

// The worst that was met, and where.
struct Deviation {
    AxisValues steps{};      // of each axis
    double distance_mm = 0;  // in space, x y z together
    double worst_steps = 0;  // of all axes
    std::size_t worst_axis = 0;
    std::uint32_t worst_layer = 0;
    AxisValues worst_at_mm{};
};

class PathCheck {
public:
    // A curve that comes this close to a middle may have touched it: far above rounding, far below what
    // a motor can show.
    static constexpr double touch_steps = 1e-6;
    static constexpr double lost_steps = 16;
    // A reading that is worse than another by this much will not become the better one: the right one is never off by
    // more than half a step.
    static constexpr double left_behind_steps = 0.05;
    static constexpr std::size_t most_readings = 16;

    // Position 0 of the decoder is at origin_mm.
    PathCheck(const AxisValues& steps_per_mm, const AxisValues& origin_mm, CurveSource source);

    void step(const DecodedStep& step);
    // The rest of the file's path, against the last position.
    void finish(const StepPositions& positions);

    // Of the best reading.
    const Deviation& deviation() const { return readings_.front().deviation; }
    bool lost() const { return deviation().worst_steps > lost_steps; }
    // Reading the file failed.
    const Status& status() const { return status_; }

private:
    struct Reading {
        std::size_t curve = 0;    // how many the source has given before it
        double share = 1;         // of the curve, up to which it was followed
        AxisValues point_mm{};    // there
        double distance_mm2 = 0;  // the largest, squared
        Deviation deviation;
    };
    struct Due;

    enum class Sought : std::uint8_t { passed, touched, nowhere };

    // Moves the reading to the first place where the step may be due, and appends readings for further ones.
    void place(std::size_t index, const Due& due);
    // Moves on to where the step may be due next, with `again` later than where the reading is.
    Sought seek(Reading& reading, const Due& due, bool again);
    bool next_curve(Reading& reading);
    const PathCurve& curve_of(const Reading& reading) const {
        return curves_[reading.curve - dropped_];
    }
    void follow_to(Reading& reading, double share, const StepPositions& positions) const;
    void step_here(Reading& reading, const Due& due) const;
    void sift();
    // All axes at a point of the curve, and the stepping one alone after its step.
    void measure(Reading& reading, const AxisValues& at_mm, const StepPositions& positions) const;
    double measure(Reading& reading, std::size_t axis, const AxisValues& at_mm,
                   std::int64_t position) const;
    double position_mm(std::size_t axis, double steps) const {
        return origin_mm_[axis] + steps * step_mm_[axis];
    }

    AxisValues steps_per_mm_, step_mm_{}, origin_mm_;
    CurveSource source_;
    std::deque<PathCurve> curves_;  // from that of the reading that is furthest behind
    std::size_t dropped_ = 0;       // before them
    bool ended_ = false;
    std::vector<Reading> readings_;  // the best first; never empty
    Status status_ = Done{};
};

}  // namespace lyr::run
