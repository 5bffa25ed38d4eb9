#include "kernel/toolpath/point_tree.h"

#include <algorithm>
#include <limits>

namespace lyr {
namespace {

// Points are looked at one by one below this many: a node costs about as much as these.
constexpr std::uint32_t leaf_size = 8;

constexpr std::uint32_t no_node = ~std::uint32_t{0};

template <class List>
std::uint32_t count_of(const List& list) {
    return static_cast<std::uint32_t>(list.size());
}

}  // namespace

PointTree::PointTree(std::span<const Point2> points) : leaf_of_(points.size()) {
    items_.reserve(points.size());
    for (const Point2& point : points) items_.push_back({point, count_of(items_)});
    nodes_.reserve(points.size() / 2 + 1);
    if (!items_.empty()) build(0, count_of(items_), no_node);
}

void PointTree::build(std::uint32_t first, std::uint32_t last, std::uint32_t parent) {
    const auto index = count_of(nodes_);
    Eigen::AlignedBox2d box;
    for (std::uint32_t i = first; i < last; ++i) box.extend(items_[i].point);
    nodes_.push_back({box.min(), box.max(), first, last, 0, parent, last - first});
    if (last - first <= leaf_size) {
        for (std::uint32_t i = first; i < last; ++i) leaf_of_[items_[i].index] = index;
        return;
    }
    const int axis = box.sizes().x() >= box.sizes().y() ? 0 : 1;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                     [&](const Item& a, const Item& b) { return a.point[axis] < b.point[axis]; });
    build(first, middle, index);
    nodes_[index].second = count_of(nodes_);
    build(middle, last, index);
}

void PointTree::remove(std::uint32_t index) {
    const Node& leaf = nodes_[leaf_of_[index]];
    for (std::uint32_t i = leaf.first; i < leaf.last; ++i)
        items_[i].removed |= items_[i].index == index;
    for (std::uint32_t node = leaf_of_[index]; node != no_node; node = nodes_[node].parent)
        --nodes_[node].left;
}

class PointTree::Search {
public:
    Search(const PointTree& tree, const Point2& place, std::size_t most, std::vector<Found>& found)
        : tree_(tree), place_(place), most_(most), found_(found) {}

    void visit(const Node& node, double square_mm2) {
        if (node.left == 0 || square_mm2 > limit_mm2_) return;
        if (node.second == 0) {
            for (std::uint32_t i = node.first; i < node.last; ++i) take(tree_.items_[i]);
            return;
        }
        const Node &one = *(&node + 1), &other = tree_.nodes_[node.second];
        const double to_one = square_to(one), to_other = square_to(other);
        if (to_one <= to_other) {
            visit(one, to_one);
            visit(other, to_other);
        } else {
            visit(other, to_other);
            visit(one, to_one);
        }
    }

    double square_to(const Node& node) const {
        const double x = std::max({node.low.x() - place_.x(), place_.x() - node.high.x(), 0.0});
        const double y = std::max({node.low.y() - place_.y(), place_.y() - node.high.y(), 0.0});
        return x * x + y * y;
    }

private:
    static bool is_nearer(const Found& a, const Found& b) {
        return a.square_mm2 < b.square_mm2 || (a.square_mm2 == b.square_mm2 && a.index < b.index);
    }

    void take(const Item& item) {
        const Found found{(item.point - place_).squaredNorm(), item.index};
        if (found.square_mm2 > limit_mm2_ || item.removed) return;
        if (found_.size() < most_) {
            found_.push_back(found);
        } else if (!is_nearer(found, found_.back())) {
            return;
        }
        std::size_t i = found_.size() - 1;
        for (; i > 0 && is_nearer(found, found_[i - 1]); --i) found_[i] = found_[i - 1];
        found_[i] = found;
        if (found_.size() == most_) limit_mm2_ = found_.back().square_mm2;
    }

    const PointTree& tree_;
    Point2 place_;
    std::size_t most_;
    double limit_mm2_ =
        std::numeric_limits<double>::infinity();  // what is farther is not asked for
    std::vector<Found>& found_;                   // sorted
};

void PointTree::nearest(const Point2& place, std::size_t most, std::vector<Found>& found) const {
    found.clear();
    if (nodes_.empty() || most == 0) return;
    Search search(*this, place, most, found);
    search.visit(nodes_.front(), search.square_to(nodes_.front()));
}

}  // namespace lyr
