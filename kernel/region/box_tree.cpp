#include "kernel/region/box_tree.h"

#include <algorithm>
#include <numeric>

namespace lyr::region {
namespace {

// Boxes are looked at one by one below this many: a node costs about as much as these.
constexpr std::uint32_t leaf_size = 8;

}  // namespace

BoxTree::BoxTree(std::span<const Box2> boxes) : items_(boxes.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    boxes_.assign(boxes.begin(), boxes.end());
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
    for (std::size_t i = 0; i < items_.size(); ++i) boxes_[i] = boxes[items_[i]];
}

void BoxTree::build(std::uint32_t first, std::uint32_t last) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Box2 box;
    for (std::uint32_t i = first; i < last; ++i) box.extend(boxes_[items_[i]]);
    nodes_.push_back({box, first, last, 0});
    if (last - first <= leaf_size) return;
    const int axis = box.sizes().x() >= box.sizes().y() ? 0 : 1;
    const std::uint32_t middle = first + (last - first) / 2;
    const auto centre = [&](std::uint32_t item) {
        return boxes_[item].min()[axis] + boxes_[item].max()[axis];
    };
    std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    build(first, middle);
    nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
    build(middle, last);
}

}  // namespace lyr::region
