// The grid of parallel rows on which hatch runs lie, and where a point of it is: in whole numbers,
// so that every reader finds the same quantum.
//
// With direction (a, b) in 2^-30 (a unit vector, rounded), row k lies
//     w = floor((offset + k x pitch) / 2^24 + 1/2)
// quanta to the left of the direction's line through the origin, and the point u quanta along it is
//     x = floor((u a - w b) / 2^30 + 1/2),  y = floor((u b + w a) / 2^30 + 1/2).
// |u|, |w| <= 3 x 2^30 (which holds every point within coordinate_limit), so 64 bits are enough.

#pragma once

#include <cstdint>
#include <optional>

#include "format/operation.h"

namespace lyr::format {

inline constexpr std::int64_t hatch_limit = std::int64_t{3} << 30;
inline constexpr int direction_bits = 30, offset_bits = 24;
// |offset + k x pitch| stays below this: hatch_limit in its unit.
inline constexpr std::int64_t offset_limit = hatch_limit << offset_bits;
// Rows have numbers within this: twice as many as a hatch may have in front of its first one.
inline constexpr std::int64_t row_limit = std::int64_t{1} << 34;

struct Grid {
    std::int64_t a = std::int64_t{1} << direction_bits, b = 0;
    std::int64_t offset = 0, pitch = 0;  // in 2^-24 quanta
    friend bool operator==(const Grid&, const Grid&) = default;

    // Is (a, b) as long as a rounded unit vector?
    bool direction_is_unit() const {
        constexpr std::int64_t one = std::int64_t{1} << direction_bits;
        if (a < -one || a > one || b < -one || b > one) return false;
        // Half a unit off in each of a and b changes the square by at most sqrt(2) x 2^30 and 1/2.
        const std::int64_t off = a * a + b * b - (one << direction_bits);
        return off >= -2 * one && off <= 2 * one;
    }

    // None: out of range.
    std::optional<std::int64_t> row(std::int64_t k) const {
        if (k < -row_limit || k > row_limit) return std::nullopt;
        const std::int64_t far = k < 0 ? -k : k, step = pitch < 0 ? -pitch : pitch;
        if (far != 0 && step > 2 * offset_limit / far) return std::nullopt;
        const std::int64_t at = offset + k * pitch;
        if (at < -offset_limit || at > offset_limit) return std::nullopt;
        return (at + (std::int64_t{1} << (offset_bits - 1))) >> offset_bits;
    }

    std::int64_t x(std::int64_t u, std::int64_t w) const { return rounded(u * a - w * b); }
    std::int64_t y(std::int64_t u, std::int64_t w) const { return rounded(u * b + w * a); }

private:
    static std::int64_t rounded(std::int64_t value) {
        return (value + (std::int64_t{1} << (direction_bits - 1))) >> direction_bits;
    }
};

}  // namespace lyr::format
