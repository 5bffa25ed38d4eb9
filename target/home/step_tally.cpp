#include "target/home/step_tally.h"

#include <algorithm>
#include <bit>

namespace lyr::home {
namespace {

// `sign`: 1 makes the steps, -1 takes them back.
void count(gpio::LineMask edges, int sign, motion::StepCounts& counts) {
    for (gpio::LineMask steps = edges & run::all_step_bits; steps; steps &= steps - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(steps)) / 2;
        counts[axis] += edges & run::direction_bit(axis) ? sign : -sign;
    }
}

}  // namespace

Status StepTally::write(gpio::LineMask changed, gpio::LineMask levels) {
    const std::int64_t time_ns = clock_.now_ns();
    Status written = inner_.write(changed, levels);
    if (!written) return written;
    const gpio::LineMask after = (levels_ & ~changed) | (levels & changed);
    const gpio::LineMask rising = after & ~levels_ & run::all_step_bits;
    levels_ = after;
    if (!rising) return written;
    const gpio::LineMask edges = rising | (after & rising << 1);
    seen_[writes_++ & (remembered - 1)] =
        static_cast<std::uint64_t>(time_ns - begin_ns_) << edge_bits | edges;
    count(edges, 1, counts_);
    return written;
}

std::optional<motion::StepCounts> StepTally::counts_at(std::int64_t time_ns) const {
    motion::StepCounts counts = counts_;
    const std::size_t known = std::min(writes_, remembered);
    for (std::size_t back = 1; back <= known; ++back) {
        const std::uint64_t seen = seen_[(writes_ - back) & (remembered - 1)];
        if (static_cast<std::int64_t>(seen >> edge_bits) <= time_ns - begin_ns_) return counts;
        count(seen & ((1u << edge_bits) - 1), -1, counts);
    }
    if (writes_ > remembered) return std::nullopt;
    return counts;
}

}  // namespace lyr::home
