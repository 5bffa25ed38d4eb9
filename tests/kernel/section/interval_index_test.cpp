#include <doctest/doctest.h>

#include <random>
#include <set>

#include "kernel/section/interval_index.h"

using namespace lyr;

TEST_CASE("interval index 1: stab visits exactly the intervals that hold the height") {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coordinate(0, 40);
    for (int round = 0; round < 200; ++round) {
        std::vector<HeightInterval> intervals;
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(round); ++i) {
            const double a = coordinate(random), b = coordinate(random);
            intervals.push_back({std::min(a, b), std::max(a, b), i});
        }
        const IntervalIndex index(intervals);
        for (double z = -0.5; z < 41; z += 0.5) {
            std::multiset<std::uint32_t> expected, found;
            for (const auto& interval : intervals) {
                if (interval.bottom_mm <= z && z < interval.top_mm) expected.insert(interval.item);
            }
            index.stab(z, [&](std::uint32_t item) { found.insert(item); });
            CHECK(found == expected);
        }
    }
}
