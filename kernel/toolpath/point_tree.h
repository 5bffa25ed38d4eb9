// Points in the plane in a tree: which are nearest to a place. Points can be taken out.
//
// Contract
//  1. nearest() gives the indices of the `most` points that are left and nearest, nearest first, of equally near ones the
//     one with the smaller index.
//  2. Building takes time n log n, a question log n besides what it finds, wherever the points lie.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr {

class PointTree {
public:
    struct Found {
        double square_mm2;  // of the distance
        std::uint32_t index;
    };

    explicit PointTree(std::span<const Point2> points);

    // In place of what `found` held.
    void nearest(const Point2& place, std::size_t most, std::vector<Found>& found) const;
    // Once for each point.
    void remove(std::uint32_t index);

private:
    // A leaf holds items [first, last); an inner node's children are the next node and `second`.
    struct Node {
        Point2 low, high;
        std::uint32_t first, last, second, parent;
        std::uint32_t left;  // not taken out
    };
    struct Item {
        Point2 point;
        std::uint32_t index;
        bool removed = false;
    };
    class Search;

    void build(std::uint32_t first, std::uint32_t last, std::uint32_t parent);

    std::vector<Item> items_;
    std::vector<std::uint32_t> leaf_of_;  // by point
    std::vector<Node> nodes_;
};

}  // namespace lyr
