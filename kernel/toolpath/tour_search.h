// The search for a short tour of stops that have no order of their own.
//
// Contract
//  1. It starts as the tour that always goes to the nearest end.
//  2. improve() and shake() never make it longer.
//
// A tour is seen as a set of links between the stops' ends: each end has one. The head's first position is a stop too,
// whose other end is linked to the tour's last one without a length; so the tour is a ring, and may be run either way.

#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "kernel/toolpath/tour.h"

namespace lyr {

class PointTree;

class TourSearch {
public:
    TourSearch(std::span<const Stop> stops, const Point2& from);

    // Until no exchange of two links and no moving of a few stops makes the tour shorter.
    void improve();
    // Exchanges two neighbouring runs at random and improves from there; taken back if that is no gain.
    void shake(std::size_t times);

    std::vector<Visit> visits() const;

private:
    // An end of a stop: 2 * stop, or 2 * stop + 1 for its last point.
    using End = std::uint32_t;

    // c becomes a's link: by an exchange, or with the block from c to t.
    struct Move {
        double gain_mm;
        End a, c, t;
        bool is_exchange;
    };

    void find_near_ends(const PointTree& tree, std::span<const End> ends);
    void start_nearest_first(PointTree& tree, std::span<const End> ends);

    std::uint32_t count() const { return static_cast<std::uint32_t>(order_.size()); }
    End free_end() const { return static_cast<End>(points_.size()) - 2; }
    End head_end() const { return static_cast<End>(points_.size()) - 1; }
    bool is_closed(End end) const { return closed_[end / 2]; }
    bool is_entry(End end) const { return order_[position_[end / 2]] == end; }
    End link(End end) const;
    double distance_mm(End a, End b) const;
    std::span<const End> near(End end) const;

    Move best_move(End a) const;
    void consider(End a, End c, Move& best) const;
    void consider_blocks(End a, End c, Move& best) const;
    double settle();
    void apply(const Move& move);
    void move_block(End a, End c, End t);
    void exchange(End a, End c);
    void reverse(std::uint32_t first, std::uint32_t last);
    void ask_again(End end);
    void take_back();

    std::vector<Point2> points_;             // by end
    std::vector<bool> closed_;               // by stop
    std::vector<std::uint32_t> near_start_;  // by end: of near_
    std::vector<End> near_;                  // of a closed stop only the first end
    std::vector<End> order_;                 // the end at which each stop is entered
    std::vector<std::uint32_t> position_;    // by stop: in order_
    std::deque<End> asked_;                  // ends around which something has changed
    std::vector<bool> is_asked_;
    std::vector<std::pair<End, End>> exchanges_;  // since the last shake
    std::minstd_rand random_;
};

}  // namespace lyr
