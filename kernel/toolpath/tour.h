// The order in which pieces are printed, so that the way between them is near the shortest.
//
// Contract
//  1. Every stop is visited once. A closed one (its ends are the same point, bit for bit) is left where it was entered,
//     an open one at its other end; `reversed` says that it was entered at `last`.
//  2. The stops of an island come together, and within it the stages one after the other, in rising order.
//  3. Stops of one island and one stage: the way is never longer than that of always going to the nearest end, and no
//     exchange of two links, turning or moving of up to three stops to a near place makes it shorter.
//  4. The result depends on the stops alone, in the order in which they are given.
//
// Coordinates must be finite. Cost: in practice n log n, 0.1 ms for 20 stops and 20 ms for 5 000; docs/algorithms/order.md.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr {

struct Stop {
    Point2 first, last;
    std::uint32_t island = 0;
    std::uint32_t stage = 0;  // of the island: those with a lower one come first
};

inline bool is_closed(const Stop& stop) {
    return stop.first == stop.last;
}

struct Visit {
    std::uint32_t index;
    bool reversed = false;
    friend bool operator==(const Visit&, const Visit&) = default;
};

std::vector<Visit> tour(std::span<const Stop> stops, const Point2& from);

// From `from` on, without the stops themselves.
double travel_mm(std::span<const Stop> stops, std::span<const Visit> visits, const Point2& from);

}  // namespace lyr
