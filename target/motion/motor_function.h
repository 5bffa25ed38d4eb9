// Where a motor ideally is, in steps, as a function of time, on a piece of time in which no copy of the
// motion changes its phase.
//
// Method. Each copy of the motion (a tap) has a cursor at its own place in the plan: a move and a phase of
// its speed profile. From there to the nearest end of a phase all are cubics in time, in the distance or
// in the angle of an arc. A motor that is a sum of axes adds them up; a tower's carriage keeps x, y and z
// apart and takes the root, and over a crooked bed z is lifted by what x and y say.
//
// Contract
//  1. Pieces follow each other without gaps and end where a phase of a copy ends, where an arc has turned
//     by Smooth::largest_turn_rad, where the head leaves a cell of the mesh, or where nothing is known of the plan yet.
//  2. at() is exact to rounding within the piece; least_jerk() to most_jerk() holds there, and left_out() for series().

#pragma once

#include <memory>
#include <optional>
#include <span>

#include "target/motion/bed_mesh.h"
#include "target/motion/kinematics.h"
#include "target/motion/move_window.h"
#include "target/motion/smooth.h"

namespace lyr::motion {

// A time in the plan; the part is within 0..1.
struct Instant {
    std::int64_t ns = 0;
    double part_ns = 0;

    Instant after(double time_s) const;
    double seconds_since(const Instant& before) const {
        return (static_cast<double>(ns - before.ns) + (part_ns - before.part_ns)) * 1e-9;
    }
};

// What becomes of a motor after an instant.
enum class Known : std::uint8_t { piece, nothing_yet, rests_forever };

class MotorFunction {
public:
    // A sum of channels times the weights of each tap, in steps; `start_steps` is subtracted.
    static MotorFunction sum(const Taps& taps, double start_steps);
    // The taps' weights are those of x, y and z, in mm; the motor follows z, with a tower the carriage, over the bed.
    static MotorFunction in_space(const Taps& taps, const std::optional<Delta::Tower>& tower,
                                  std::shared_ptr<const BedMesh> bed, double steps_per_mm,
                                  double start_mm);

    // Moves on to the piece that begins at `begin`, which must be where the last one ended.
    Known begin_piece(const MoveWindow& window, const Instant& begin);
    double duration_s() const { return duration_s_; }
    // Since the begin of the piece.
    Sample at(double time_s) const;
    // Taylor's about that time.
    Series series(double time_s) const;
    // By series() after a time: below this times its sixth power.
    double left_out() const { return left_out_; }
    double least_jerk() const { return least_jerk_; }
    double most_jerk() const { return most_jerk_; }

    // The first move that any cursor still needs.
    std::uint64_t oldest_move() const;
    // How much later in the plan than the motor the latest copy is.
    std::int64_t ahead_ns() const;
    // And how much earlier the earliest one is.
    std::int64_t behind_ns() const;

private:
    // A place on the circle of an arc: a turn goes on from where it was, by the angle since.
    struct OnCircle {
        double turned_rad = 0;
        double x_mm = 0, y_mm = 0;
        double sine_mm = 0, cosine_mm = 0;  // of the angle on the circle, times its radius
        bool is_known = false;
    };
    struct Cursor {
        Tap tap;
        std::uint64_t move = 0;
        std::size_t phase = 0;
        OnCircle place{};
    };

    // How far a cell of the mesh goes on beyond its bounds, so that rounding at them is no crossing.
    static constexpr double cell_overlap_mm = 1e-9;

    MotorFunction(const Taps& taps, bool in_space);
    // False: the plan does not reach so far yet.
    bool add(Cursor& cursor, const MoveWindow& window, const Instant& begin);
    void add_rest(const Tap& tap, const ChannelValues& at);
    void add_moving(Cursor& cursor, const ChannelMove& move, double since_s);
    void add_turn(Cursor& cursor, const ChannelMove& move, double distance_mm,
                  const TurnAngle& angle);
    static OnCircle place_on(const ChannelMove& move, double turned_rad);
    static void turn_on(OnCircle& place, double turned_rad);
    Smooth& smooth_of(std::size_t channel) { return smooth_[in_space_ ? channel : 0]; }
    void stay_in_cell();
    // Of the tower's carriage over the head.
    Series height(const Series& x, const Series& y) const;
    Sizes sizes_of_height(const Sizes& x, const Sizes& y) const;
    Series series_in_space(double time_s) const;
    Sizes sizes_in_space() const;
    void set_bounds();
    void end_no_later_than(double time_s) {
        if (time_s < duration_s_) duration_s_ = time_s;
    }

    std::vector<Cursor> cursors_;
    bool in_space_ = false;
    std::optional<Delta::Tower> tower_;
    std::shared_ptr<const BedMesh> bed_;
    std::optional<MeshCell> cell_;
    double steps_per_mm_ = 1, start_ = 0;
    std::array<Smooth, 3> smooth_;
    double duration_s_ = 0, least_jerk_ = 0, most_jerk_ = 0, left_out_ = 0;
};

}  // namespace lyr::motion
