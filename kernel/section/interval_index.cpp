// Builds the implicit tree: sort, then the greatest top of each subtree from the leaves up.

#include "kernel/section/interval_index.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace lyr {

IntervalIndex::IntervalIndex(std::vector<HeightInterval> intervals)
    : intervals_(std::move(intervals)), greatest_top_mm_(intervals_.size()) {
    std::sort(intervals_.begin(), intervals_.end(), [](const auto& a, const auto& b) {
        return std::tie(a.bottom_mm, a.item) < std::tie(b.bottom_mm, b.item);
    });
    fill_tops(0, intervals_.size());
}

double IntervalIndex::fill_tops(std::size_t first, std::size_t last) {
    if (first >= last) return -std::numeric_limits<double>::infinity();
    const std::size_t root = first + (last - first) / 2;
    const double below = std::max(fill_tops(first, root), fill_tops(root + 1, last));
    return greatest_top_mm_[root] = std::max(below, intervals_[root].top_mm);
}

}  // namespace lyr
