// The moves of the plan that someone still looks at, with what each of them is for every channel.
//
// Contract
//  1. Moves keep the number under which they came in, from 0 on.
//  2. Memory grows only when more moves are kept than ever before, beyond `expected`.

#pragma once

#include <limits>
#include <vector>

#include "target/motion/planner.h"
#include "target/motion/tap.h"

namespace lyr::motion {

// A move by channels: linear in the distance, and on an arc x and y round a circle.
struct ChannelMove {
    std::int64_t start_ns = 0;
    double start_part_ns = 0;
    Profile profile;
    ChannelValues from{}, slope{}, to{};  // mm, mm per mm, mm
    bool turns = false;
    double radius_mm = 0, start_angle_rad = 0, rate = 0;  // rad per mm, with its sign
    Point start;
    std::uint32_t tag = 0;
};

class MoveWindow {
public:
    static constexpr std::size_t expected = 1024;

    MoveWindow() : ring_(expected) {}

    void push(const PlannedMove& planned);
    // After the last move so far the plan rests until then.
    void rest_until(std::int64_t plan_ns) { rests_until_ns_ = plan_ns; }
    std::int64_t rests_until_ns() const { return rests_until_ns_; }
    // Moves before this one are not looked at any more.
    void drop_before(std::uint64_t number);

    std::uint64_t first() const { return first_; }
    std::uint64_t end() const { return first_ + size_; }
    const ChannelMove& at(std::uint64_t number) const { return ring_[place(number)]; }

private:
    void grow();
    std::size_t place(std::uint64_t number) const {
        return static_cast<std::size_t>(number) & (ring_.size() - 1);
    }

    std::vector<ChannelMove> ring_;  // a power of two; move n lies at n modulo the size
    std::uint64_t first_ = 0;
    std::size_t size_ = 0;
    // Filament since the begin, with compensation: hundreds of thousands of roundings would be parts of
    // a step.
    double fed_mm_ = 0, fed_error_mm_ = 0;
    double pressed_mm_ = 0;
    std::int64_t rests_until_ns_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace lyr::motion
