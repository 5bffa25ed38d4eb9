#include "target/home/step_tally.h"

#include <algorithm>
#include <bit>

namespace lyr::home {

Status StepTally::write(gpio::LineMask changed, gpio::LineMask levels) {
    const std::int64_t time_ns = clock_.now_ns();
    Status written = inner_.write(changed, levels);
    if (!written) return written;
    const gpio::LineMask after = (levels_ & ~changed) | (levels & changed);
    gpio::LineMask rising = after & ~levels_ & run::all_step_bits;
    levels_ = after;
    if (!rising) return written;
    seen_[writes_++ & (remembered - 1)] = {time_ns, counts_};
    for (; rising; rising &= rising - 1) {
        const auto axis = static_cast<std::size_t>(std::countr_zero(rising)) / 2;
        counts_[axis] += after & run::direction_bit(axis) ? 1 : -1;
    }
    return written;
}

std::optional<motion::StepCounts> StepTally::counts_at(std::int64_t time_ns) const {
    motion::StepCounts counts = counts_;
    const std::size_t known = std::min(writes_, remembered);
    for (std::size_t back = 1; back <= known; ++back) {
        const Seen& seen = seen_[(writes_ - back) & (remembered - 1)];
        if (seen.time_ns <= time_ns) return counts;
        counts = seen.before;
    }
    if (writes_ > remembered) return std::nullopt;
    return counts;
}

}  // namespace lyr::home
