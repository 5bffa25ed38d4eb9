// Which of many height intervals hold a given height? Built once, asked for every plane.
//
// Contract
//  1. stab(h) visits every interval with bottom <= h < top, each once, in an order that depends on the
//     intervals alone.
//  2. A query costs O(log n + hits): intervals that the plane does not meet cost nothing.
//
// Method: intervals sorted by bottom in an implicit balanced tree whose nodes keep the greatest top below them
// (Cormen et al., Introduction to Algorithms, 14.3).

#pragma once

#include <cstdint>
#include <vector>

namespace lyr {

struct HeightInterval {
    double bottom_mm, top_mm;
    std::uint32_t item;
};

class IntervalIndex {
public:
    IntervalIndex() = default;
    explicit IntervalIndex(std::vector<HeightInterval> intervals);

    template <class Visit>
    void stab(double z_mm, Visit&& visit) const {
        stab_range(0, intervals_.size(), z_mm, visit);
    }

private:
    // The tree of [first, last) has its root in the middle.
    template <class Visit>
    void stab_range(std::size_t first, std::size_t last, double z_mm, Visit& visit) const {
        while (first < last) {
            const std::size_t root = first + (last - first) / 2;
            if (!(z_mm < greatest_top_mm_[root])) return;
            stab_range(first, root, z_mm, visit);
            const HeightInterval& interval = intervals_[root];
            if (interval.bottom_mm > z_mm) return;
            if (z_mm < interval.top_mm) visit(interval.item);
            first = root + 1;
        }
    }

    double fill_tops(std::size_t first, std::size_t last);

    std::vector<HeightInterval> intervals_;
    std::vector<double> greatest_top_mm_;
};

}  // namespace lyr
