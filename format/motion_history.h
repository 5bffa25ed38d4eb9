// The last lines and arcs of a layer, and what they say of the next one: the wall beside a wall runs along it, and a smooth
// path goes on as it came. Packed runs store the difference from that.
//
// Contract
//  1. The rules are part of the file format (docs/lyr-format.md, "Packed runs"): reader and writer must agree on every
//     bit. Only + - * / and the square root of IEEE doubles are used, in the order that is written there, without fused
//     multiply-add.
//  2. Memory is fixed.
//  3. Any motions give finite predictions: what is no number or too far away is predicted as 0.

#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/operation.h"

namespace lyr::format {

// In the plane; sagitta 0: a line. It has a length.
struct PlaneMotion {
    std::int32_t from_x = 0, from_y = 0, to_x = 0, to_y = 0;
    std::int64_t sagitta = 0;
};

inline PlaneMotion plane_motion(const Point& from, const Point& to, std::int64_t sagitta) {
    return {static_cast<std::int32_t>(from.x), static_cast<std::int32_t>(from.y),
            static_cast<std::int32_t>(to.x), static_cast<std::int32_t>(to.y), sagitta};
}

class MotionHistory {
public:
    static constexpr std::uint64_t window = 1024;

    void clear() { count_ = 0; }
    void add(const PlaneMotion& motion) {
        motions_[static_cast<std::size_t>(count_++ % window)] = motion;
    }

    // Motions so far, and how many of the last ones are kept.
    std::uint64_t count() const { return count_; }
    std::uint64_t kept() const { return count_ < window ? count_ : window; }
    // The motion with this number, from 0; it must be kept.
    const PlaneMotion& operator[](std::uint64_t number) const {
        return motions_[static_cast<std::size_t>(number % window)];
    }

private:
    std::array<PlaneMotion, window> motions_{};
    std::uint64_t count_ = 0;
};

// The nearest whole number, the even one of two; 0 if the value is 2^40 or more in size.
inline std::int64_t nearest(double value) {
    constexpr double limit = 1099511627776.0;
    // Doubles of this size are whole numbers, one unit apart.
    constexpr double whole = 6755399441055744.0;  // 1.5 x 2^52
    if (!(std::abs(value) < limit)) return 0;
    return static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(value + whole) -
                                     std::bit_cast<std::uint64_t>(whole));
}

struct Vector {
    double x = 0, y = 0;
};

inline double length_of(const Vector& vector) {
    return std::sqrt(vector.x * vector.x + vector.y * vector.y);
}

inline Vector chord_of(const PlaneMotion& motion) {
    return {static_cast<double>(motion.to_x) - motion.from_x,
            static_cast<double>(motion.to_y) - motion.from_y};
}

// The directions in which a motion starts and ends: vectors of length `size`. Its curvature is in 1 / quanta, positive to
// the left.
struct Course {
    Vector start, end;
    double size = 0, curvature = 0;
};

// An arc's direction at its ends and its chord make half the arc's turn, whose tangent is 4 c s / (c^2 - 4 s^2).
inline Course course_of(const PlaneMotion& motion) {
    const Vector chord = chord_of(motion);
    const auto sagitta = static_cast<double>(motion.sagitta);
    const double square = chord.x * chord.x + chord.y * chord.y, length = std::sqrt(square);
    const double rise = 4 * sagitta * sagitta;
    const double along = square - rise, across = 4 * sagitta * length, sum = square + rise;
    return {{chord.x * along + chord.y * across, chord.y * along - chord.x * across},
            {chord.x * along - chord.y * across, chord.y * along + chord.x * across},
            length * sum,
            8 * sagitta / sum};
}

// Where what runs beside `old` ends, `distance` to its left: at the corner with what runs beside the motion that leaves
// old's end in the direction `next` (of length next_size), unless that turns back by more than 120 degrees.
struct Place {
    std::int64_t x = 0, y = 0;
};

inline Place end_beside(const PlaneMotion& old, const Course& course, Vector next, double next_size,
                        double distance) {
    double cosine = course.end.x * next.x + course.end.y * next.y, one = course.size * next_size;
    if (cosine < -0.5 * one) {
        next = course.end;
        next_size = course.size;
        cosine = one = course.size * course.size;
    }
    const double reach = distance / (one + cosine);
    return {nearest(old.to_x - reach * (course.end.y * next_size + next.y * course.size)),
            nearest(old.to_y + reach * (course.end.x * next_size + next.x * course.size))};
}

// An arc beside an arc has the same centre: it is smaller as its radius is.
inline std::int64_t sagitta_beside(const PlaneMotion& old, const Course& course, double distance) {
    return nearest(static_cast<double>(old.sagitta) * (1 - distance * course.curvature));
}

// The sagitta with which a motion goes on smoothly from another; 0 if it turned by more than 106 degrees: there is a
// corner. A chord of length c and the arc's direction at its ends make an angle of 2 atan(2 s / c). The angles of both
// motions make the angle between the chords, and the tangent of a difference is (b - t) / (1 + b t).
inline std::int64_t smooth_sagitta(const Vector& before, double before_length,
                                   std::int64_t before_sagitta, const Vector& chord,
                                   double length) {
    const double across = before.x * chord.y - before.y * chord.x;
    const double along = before.x * chord.x + before.y * chord.y;
    // Half the angle between the chords has the tangent across / turn.
    const double turn = before_length * length + along;
    const double rise = 2 * static_cast<double>(before_sagitta);
    const double sagitta = length * (across * before_length - rise * turn) /
                           (2 * (before_length * turn + across * rise));
    return sagitta * 4 > length || sagitta * -4 > length ? 0 : nearest(sagitta);
}

}  // namespace lyr::format
