// Motion as a weighted sum of copies of itself, each a little earlier or later. That is all that input
// shaping and smoothed pressure advance are: both leave a motion that ends where it did.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "target/motion/path.h"

namespace lyr::motion {

// What a motor can follow: x, y, z, all filament, and the filament that is laid down while the head
// moves, which is what builds up pressure.
inline constexpr std::size_t pressed_channel = axis_count;
inline constexpr std::size_t channel_count = axis_count + 1;
using ChannelValues = std::array<double, channel_count>;

// The copy of the motion `offset_ns` later in the plan, with a weight for each channel.
struct Tap {
    std::int64_t offset_ns = 0;
    ChannelValues weights{};
};
using Taps = std::vector<Tap>;

}  // namespace lyr::motion
