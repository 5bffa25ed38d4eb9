// Points that are kept apart: one that comes too near to another is that other.

#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernel/geometry/vector.h"

namespace lyr::region {

class VertexSet {
public:
    explicit VertexSet(double apart_mm) : apart_mm_(apart_mm) {}

    // The nearest vertex within apart_mm; if there is none, a new one, which is points().size() before.
    std::uint32_t add(const Point2& point) {
        // A cell is as wide as what lies within apart_mm on both sides: that is in no more than two.
        const Vector2 margin(apart_mm_, apart_mm_);
        const Cell low = cell_of(point - margin), high = cell_of(point + margin);
        std::uint32_t best = static_cast<std::uint32_t>(points_.size());
        double best_mm = apart_mm_;
        for (std::int64_t y = low.y; y <= high.y; ++y) {
            for (std::int64_t x = low.x; x <= high.x; ++x) {
                const auto found = last_in_.find({x, y});
                if (found == last_in_.end()) continue;
                for (std::uint32_t v = found->second; v != end_of_cell; v = next_in_cell_[v]) {
                    const double distance = (points_[v] - point).norm();
                    if (distance > best_mm || (distance == best_mm && v > best)) continue;
                    best = v;
                    best_mm = distance;
                }
            }
        }
        if (best == points_.size()) append(point);
        return best;
    }

    // A new vertex, however near to others.
    void append(const Point2& point) {
        const auto [at, fresh] = last_in_.try_emplace(cell_of(point), end_of_cell);
        next_in_cell_.push_back(at->second);
        at->second = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
    }

    const std::vector<Point2>& points() const { return points_; }

private:
    struct Cell {
        std::int64_t x, y;
        bool operator==(const Cell&) const = default;
    };
    struct CellHash {
        std::size_t operator()(const Cell& cell) const {
            // Odd factors spread neighbouring cells over the table.
            return static_cast<std::size_t>(cell.x) * 0x9E3779B97F4A7C15u ^
                   static_cast<std::size_t>(cell.y) * 0xC2B2AE3D27D4EB4Fu;
        }
    };
    static constexpr std::uint32_t end_of_cell = ~std::uint32_t{0};

    Cell cell_of(const Point2& point) const {
        return {std::llround(point.x() / (2 * apart_mm_)),
                std::llround(point.y() / (2 * apart_mm_))};
    }

    double apart_mm_;
    std::vector<Point2> points_;
    std::vector<std::uint32_t> next_in_cell_;
    std::unordered_map<Cell, std::uint32_t, CellHash> last_in_;
};

}  // namespace lyr::region
