// Boxes in a tree: which of them meet a box.
//
// Boxes that come in an order in which neighbours are near each other, as along contours, are halved as they come, which
// is quickly done; others along the longer side of what they lie in.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/region/curve.h"

namespace lyr::region {

enum class BoxOrder { along_contours, any };

class BoxTree {
public:
    BoxTree(std::span<const Box2> boxes, BoxOrder order);

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

    // Whether holds(index) is true for any box that meets `box`; it is asked no more once it does.
    template <class Holds>
    bool any(const Box2& box, Holds holds) const {
        return !nodes_.empty() && any(0, box, holds);
    }

    Box2 bounds() const { return nodes_.empty() ? Box2() : nodes_.front().box; }

private:
    // A leaf holds items [first, last); an inner node's children are the next node and `second`.
    struct Node {
        Box2 box;
        std::uint32_t first, last, second;
    };

    void build(std::uint32_t first, std::uint32_t last);

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

    template <class Holds>
    bool any(std::uint32_t index, const Box2& box, Holds& holds) const {
        const Node& node = nodes_[index];
        if (!node.box.intersects(box)) return false;
        if (node.second != 0) return any(index + 1, box, holds) || any(node.second, box, holds);
        for (std::uint32_t i = node.first; i < node.last; ++i)
            if (boxes_[i].intersects(box) && holds(items_[i])) return true;
        return false;
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_;
    std::vector<Box2> boxes_;  // in the order of items_
};

}  // namespace lyr::region
