#include "base/disjoint_sets.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

namespace lyr {
namespace {

using Join = std::pair<std::uint32_t, std::uint32_t>;

std::vector<std::uint32_t> sets_of(std::uint32_t count, const std::vector<Join>& joins) {
    DisjointSets sets(count);
    for (const auto& [a, b] : joins) sets.join(a, b);
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < count; ++i) result.push_back(sets.of(i));
    return result;
}

// Each takes the lowest number of what it is joined with until nothing changes.
std::vector<std::uint32_t> spread(std::uint32_t count, const std::vector<Join>& joins) {
    std::vector<std::uint32_t> lowest(count);
    for (std::uint32_t i = 0; i < count; ++i) lowest[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : joins) {
            const std::uint32_t least = std::min(lowest[a], lowest[b]);
            changed = changed || lowest[a] != least || lowest[b] != least;
            lowest[a] = lowest[b] = least;
        }
    }
    return lowest;
}

}  // namespace

TEST_CASE("disjoint sets: everything is alone to begin with") {
    CHECK(sets_of(3, {}) == std::vector<std::uint32_t>{0, 1, 2});
}

TEST_CASE("disjoint sets: the lowest number stands for a set, in whatever order it was joined") {
    constexpr std::uint32_t count = 200;
    std::mt19937 random(1);
    for (const std::uint32_t joined : {20u, 100u, 180u, 400u}) {
        std::vector<Join> joins;
        for (std::uint32_t i = 0; i < joined; ++i)
            joins.emplace_back(random() % count, random() % count);
        const auto expected = spread(count, joins);
        CHECK(sets_of(count, joins) == expected);
        std::shuffle(joins.begin(), joins.end(), random);
        for (Join& join : joins) std::swap(join.first, join.second);
        CHECK(sets_of(count, joins) == expected);
    }
}

}  // namespace lyr
