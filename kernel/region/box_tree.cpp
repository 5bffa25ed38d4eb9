#include "kernel/region/box_tree.h"

#include <algorithm>

namespace lyr::region {
namespace {

// Boxes are looked at one by one below this many: a node costs about as much as these.
constexpr std::uint32_t leaf_size = 8;

}  // namespace

BoxTree::BoxTree(std::span<const Box2> boxes) {
    std::vector<Place> places;
    places.reserve(boxes.size());
    for (const Box2& box : boxes) {
        places.push_back({box.min() + box.max(), static_cast<std::uint32_t>(places.size())});
    }
    if (!places.empty()) build(places, 0, static_cast<std::uint32_t>(places.size()));
    items_.reserve(boxes.size());
    boxes_.reserve(boxes.size());
    for (const Place& place : places) {
        items_.push_back(place.item);
        boxes_.push_back(boxes[place.item]);
    }
    // A node comes before its children.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        if (node.second != 0) {
            node.box = nodes_[i + 1].box.merged(nodes_[node.second].box);
        } else {
            for (std::uint32_t k = node.first; k < node.last; ++k) node.box.extend(boxes_[k]);
        }
    }
}

void BoxTree::build(std::span<Place> places, std::uint32_t first, std::uint32_t last) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({Box2(), first, last, 0});
    if (last - first <= leaf_size) return;
    Box2 centres;
    for (std::uint32_t i = first; i < last; ++i) centres.extend(places[i].centre2);
    const int axis = centres.sizes().x() >= centres.sizes().y() ? 0 : 1;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(
        places.begin() + first, places.begin() + middle, places.begin() + last,
        [&](const Place& a, const Place& b) { return a.centre2[axis] < b.centre2[axis]; });
    build(places, first, middle);
    nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
    build(places, middle, last);
}

}  // namespace lyr::region
