// One motor along one segment: the times at which its coordinate passes the half-way points.
//
// The coordinate is linear in the distance along a line, and along an arc a sine of the heading; an arc is cut
// at the heading's quadrants (as that motor sees them), where the motor turns or runs fastest, so that each
// piece is monotone and at most a quarter turn. In a piece, with the anchor at its slower end,
//     sin h = sin a + D,   cos h = sqrt(cos^2 a - D (2 sin a + D)),   h - a = 2 atan(D / (cos h + cos a))
// where D is the motor's travel from the anchor in radii: no term cancels, however large or small the radius.
// From the distance, the time follows by the inverse of the phase's quadratic.
//
// Contract
//  1. Times are those of the ideal crossings to kTimeError_ns, within the segment, and never decrease.
//  2. After the last, the count is the nearest one to the end's coordinate (half-way points as
//     step_generator.h, 3).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "target/motion/kinematics.h"
#include "target/motion/path.h"
#include "target/motion/profile.h"

namespace lyr::motion {

// Coordinates of a metre are known to about 1e-13 mm; a thousand times that separates a crossing from a touch.
// Some 1e-7 of a microstep.
inline constexpr double kGrazing_mm = 1e-9;

// The bound asked for. Half of a nanosecond comes from the rounding to integers; the rest is the rounding of
// coordinates (1e-13 mm) over the motor's speed where it is slowest, at kGrazing_mm before a turn.
inline constexpr double kTimeError_ns = 1000;

class MotorTrack {
public:
    static constexpr std::size_t kBatch = 64;

    // `origin_ns`: the segment's start relative to the nanosecond that times are counted from, in [0, 1).
    void begin(const MotorForm& form, const Path& path, const Profile& profile, std::int64_t count,
               double origin_ns);

    // The next step's time in nanoseconds since the segment's start; kNone when there is none left.
    static constexpr std::int64_t kNone = INT64_MAX;
    std::int64_t time_ns() const { return times_ns_[next_]; }
    bool forward() const { return forward_[next_]; }
    void advance() {
        if (++next_ == filled_) refill();
    }

private:
    void refill();

    std::array<std::int64_t, kBatch + 1> times_ns_{};
    std::array<bool, kBatch + 1> forward_{};
    std::size_t next_ = 0, filled_ = 0;
};

}  // namespace lyr::motion
