// Which of the numbers below a count are in one set, when sets are joined two by two.
//
// Contract: each number is in a set of its own to begin with. of() is the lowest number of the set, whatever the order sets
// were joined in.
//
// Cost: log n a call on average, by path halving (Tarjan & van Leeuwen, "Worst-case analysis of set union algorithms",
// J. ACM 31, 1984).

#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lyr {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count = 0) : next_(count) {
        std::iota(next_.begin(), next_.end(), 0u);
    }

    std::uint32_t of(std::uint32_t i) {
        while (next_[i] != i) i = next_[i] = next_[next_[i]];
        return i;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a);
        b = of(b);
        if (a > b) std::swap(a, b);
        next_[b] = a;
    }

private:
    std::vector<std::uint32_t> next_;  // on the way to the lowest
};

}  // namespace lyr
