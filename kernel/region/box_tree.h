// Boxes in a tree, halved along their longer side: which of them meet a box.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/region/curve.h"

namespace lyr::region {

class BoxTree {
public:
    explicit BoxTree(std::span<const Box2> boxes);

    // Calls take(index) for every box that meets `box`, borders included. The order depends on the boxes alone.
    template <class Take>
    void meeting(const Box2& box, Take take) const {
        where([&](const Box2& other) { return other.intersects(box); }, take);
    }

    // The same for every box that is `wanted`, as every box has to be that holds one that is.
    template <class Wanted, class Take>
    void where(Wanted wanted, Take take) const {
        if (!nodes_.empty()) visit(0, wanted, take);
    }

    Box2 bounds() const { return nodes_.empty() ? Box2() : nodes_.front().box; }

private:
    // A leaf holds items [first, last); an inner node's children are the next node and `second`.
    struct Node {
        Box2 box;
        std::uint32_t first, last, second;
    };

    // Twice the centre, which does as well.
    struct Place {
        Point2 centre2;
        std::uint32_t item;
    };

    void build(std::span<Place> places, std::uint32_t first, std::uint32_t last);

    template <class Wanted, class Take>
    void visit(std::uint32_t index, Wanted& wanted, Take& take) const {
        const Node& node = nodes_[index];
        if (!wanted(node.box)) return;
        if (node.second == 0) {
            for (std::uint32_t i = node.first; i < node.last; ++i) {
                if (wanted(boxes_[i])) take(items_[i]);
            }
            return;
        }
        visit(index + 1, wanted, take);
        visit(node.second, wanted, take);
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_;
    std::vector<Box2> boxes_;  // in the order of items_
};

}  // namespace lyr::region
