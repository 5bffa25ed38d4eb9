#include "kernel/region/box_tree.h"

#include <algorithm>
#include <numeric>

namespace lyr::region {
namespace {

// Boxes are looked at one by one below this many: a node costs about as much as these.
constexpr std::uint32_t leaf_size = 8;

// Twice the centre, which does as well.
struct Place {
    Point2 centre2;
    std::uint32_t item;
};

std::size_t middle_of(std::size_t count) {
    return count / 2;
}

// So that what build() halves lies on two sides of a line.
void sort_by_place(std::span<Place> places) {
    if (places.size() <= leaf_size) return;
    Box2 centres;
    for (const Place& place : places) centres.extend(place.centre2);
    const int axis = centres.sizes().x() >= centres.sizes().y() ? 0 : 1;
    const std::size_t middle = middle_of(places.size());
    std::nth_element(
        places.begin(), places.begin() + static_cast<std::ptrdiff_t>(middle), places.end(),
        [&](const Place& a, const Place& b) { return a.centre2[axis] < b.centre2[axis]; });
    sort_by_place(places.first(middle));
    sort_by_place(places.subspan(middle));
}

}  // namespace

BoxTree::BoxTree(std::span<const Box2> boxes, BoxOrder order) : items_(boxes.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    boxes_.assign(boxes.begin(), boxes.end());
    if (order == BoxOrder::any) {
        std::vector<Place> places;
        for (const std::uint32_t item : items_)
            places.push_back({boxes[item].min() + boxes[item].max(), item});
        sort_by_place(places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            items_[i] = places[i].item;
            boxes_[i] = boxes[items_[i]];
        }
    }
    if (boxes.empty()) return;
    nodes_.reserve(4 * boxes.size() / leaf_size + 1);
    build(0, static_cast<std::uint32_t>(boxes.size()));
}

// A node comes before its children.
void BoxTree::build(std::uint32_t first, std::uint32_t last) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({Box2(), first, last, 0});
    if (last - first <= leaf_size) {
        for (std::uint32_t i = first; i < last; ++i) nodes_[index].box.extend(boxes_[i]);
        return;
    }
    const auto middle = first + static_cast<std::uint32_t>(middle_of(last - first));
    build(first, middle);
    nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
    build(middle, last);
    nodes_[index].box = nodes_[index + 1].box.merged(nodes_[nodes_[index].second].box);
}

}  // namespace lyr::region
