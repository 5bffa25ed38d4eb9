// Local search over links with lists of near ends (Bentley, "Fast algorithms for geometric traveling salesman
// problems", 1992) and a queue of the ends around which something has changed. All moves are exchanges of two links,
// each of which turns a run of the tour round, so that all can be taken back.

#include "kernel/toolpath/tour_search.h"

#include <algorithm>
#include <utility>

#include "kernel/toolpath/point_tree.h"

namespace lyr {
namespace {

// A good link is hardly ever to an end that is farther down the list.
constexpr std::size_t near_count = 7;
// Longer blocks are moved by exchanges as well.
constexpr int longest_block = 3;
// Gains, and how much one exceeds another, are more than round-off of coordinates within a few metres: what is equally
// good is decided by the order of the stops, wherever they lie and however they are turned.
constexpr double least_gain_mm = 1e-9;
// A shake exchanges runs of up to this many stops: its traces stay near.
constexpr std::uint32_t longest_run = 30;

}  // namespace

TourSearch::TourSearch(std::span<const Stop> stops, const Point2& from) {
    points_.reserve(2 * stops.size() + 2);
    for (const Stop& stop : stops) {
        points_.push_back(stop.first);
        points_.push_back(stop.last);
        closed_.push_back(lyr::is_closed(stop));
    }
    // The head's stop, whose first end is linked without a length.
    points_.push_back(from);
    points_.push_back(from);
    closed_.push_back(false);
    is_asked_.resize(points_.size());
    std::vector<End> ends;  // that have a place of their own
    std::vector<Point2> places;
    for (End end = 0; end < points_.size(); ++end) {
        if (end == free_end() || (is_closed(end) && end % 2 == 1)) continue;
        ends.push_back(end);
        places.push_back(points_[end]);
    }
    PointTree tree(places);
    find_near_ends(tree, ends);
    start_nearest_first(tree, ends);
}

void TourSearch::find_near_ends(const PointTree& tree, std::span<const End> ends) {
    near_start_.assign(points_.size() + 1, 0);
    near_.reserve(near_count * ends.size());
    std::vector<PointTree::Found> found;
    for (const End end : ends) {
        // Up to two of them are the stop's own.
        tree.nearest(points_[end], near_count + 2, found);
        const std::size_t most = near_.size() + near_count;
        for (const PointTree::Found& place : found) {
            if (ends[place.index] / 2 != end / 2 && near_.size() < most)
                near_.push_back(ends[place.index]);
        }
        near_start_[end + 1] = static_cast<std::uint32_t>(near_.size());
    }
    // Ends without a place of their own have none.
    for (std::size_t i = 1; i < near_start_.size(); ++i)
        near_start_[i] = std::max(near_start_[i], near_start_[i - 1]);
}

std::span<const TourSearch::End> TourSearch::near(End end) const {
    if (is_closed(end)) end -= end % 2;
    return std::span(near_).subspan(near_start_[end], near_start_[end + 1] - near_start_[end]);
}

void TourSearch::start_nearest_first(PointTree& tree, std::span<const End> ends) {
    constexpr std::uint32_t not_yet = ~std::uint32_t{0};
    position_.assign(closed_.size(), not_yet);
    std::vector<PointTree::Found> found;
    const auto nearest_to = [&](End end) {
        for (const End other : near(end)) {
            if (position_[other / 2] == not_yet) return other;
        }
        tree.nearest(points_[end], 1, found);
        return ends[found.front().index];
    };
    std::vector<std::uint32_t> place_of(points_.size());
    for (std::uint32_t i = 0; i < ends.size(); ++i) place_of[ends[i]] = i;
    End entry = free_end();
    while (true) {
        position_[entry / 2] = count();
        order_.push_back(entry);
        if (count() == closed_.size()) return;
        if (entry != free_end()) tree.remove(place_of[entry]);
        if (!is_closed(entry)) tree.remove(place_of[entry ^ 1]);
        entry = nearest_to(entry ^ 1);
    }
}

TourSearch::End TourSearch::link(End end) const {
    const std::uint32_t position = position_[end / 2];
    if (order_[position] == end) return order_[position == 0 ? count() - 1 : position - 1] ^ 1;
    return order_[position + 1 == count() ? 0 : position + 1];
}

double TourSearch::distance_mm(End a, End b) const {
    if (a == free_end() || b == free_end()) return 0;
    return (points_[a] - points_[b]).norm();
}

TourSearch::Move TourSearch::best_move(End a) const {
    Move best{0, a, a, a, true};
    const double link_mm = distance_mm(a, link(a));
    for (const End c : near(a)) {
        if (distance_mm(a, c) >= link_mm) break;
        consider(a, c, best);
        if (is_closed(c)) consider(a, c ^ 1, best);
    }
    return best;
}

void TourSearch::consider(End a, End c, Move& best) const {
    const End b = link(a), d = link(c);
    if (b == c) return;
    if (is_entry(a) == is_entry(c)) {
        const double gain =
            distance_mm(a, b) + distance_mm(c, d) - distance_mm(a, c) - distance_mm(b, d);
        if (gain > best.gain_mm + least_gain_mm) best = {gain, a, c, c, true};
    }
    consider_blocks(a, c, best);
}

void TourSearch::consider_blocks(End a, End c, Move& best) const {
    const End b = link(a), d = link(c);
    const double common = distance_mm(a, b) + distance_mm(d, c) - distance_mm(a, c);
    End t = c ^ 1;
    for (int length = 1; length <= longest_block; ++length) {
        const End u = link(t);
        // The block has grown up to a, from either side.
        if (u == a) return;
        const double gain = common + distance_mm(t, u) - distance_mm(t, b) - distance_mm(d, u);
        if (gain > best.gain_mm + least_gain_mm) best = {gain, a, c, t, false};
        if (u / 2 == a / 2 || u == d) return;
        t = u ^ 1;
    }
}

// How much shorter the tour becomes.
double TourSearch::settle() {
    double gained = 0;
    while (!asked_.empty()) {
        const End a = asked_.front();
        asked_.pop_front();
        is_asked_[a] = false;
        const Move move = best_move(a);
        if (move.c == a) continue;
        apply(move);
        gained += move.gain_mm;
        ask_again(a);
    }
    return gained;
}

void TourSearch::improve() {
    for (const End entry : order_) {
        ask_again(entry);
        ask_again(entry ^ 1);
    }
    settle();
    exchanges_.clear();
}

void TourSearch::shake(std::size_t times) {
    if (count() < 5) return;
    const std::uint32_t most = std::min(longest_run, (count() - 2) / 2);
    const auto below = [&](std::uint32_t limit) {
        return static_cast<std::uint32_t>(random_() % limit);
    };
    const auto at = [&](std::uint32_t position) { return order_[position % count()]; };
    for (; times > 0; --times) {
        const std::uint32_t first = below(count());
        const std::uint32_t second = first + 1 + below(most), third = second + 1 + below(most);
        // The run from first on moves behind the one from second on.
        const End c = at(first), t = at(second - 1) ^ 1, a = at(third - 1) ^ 1;
        const End b = link(a), d = link(c), u = link(t);
        const double lost = distance_mm(a, c) + distance_mm(t, b) + distance_mm(d, u) -
                            distance_mm(a, b) - distance_mm(c, d) - distance_mm(t, u);
        apply({-lost, a, c, t, false});
        if (settle() - lost < least_gain_mm) take_back();
        exchanges_.clear();
    }
}

void TourSearch::take_back() {
    while (!exchanges_.empty()) {
        const auto [a, b] = exchanges_.back();
        exchange(a, b);
        exchanges_.pop_back();  // the one that exchange() noted
        exchanges_.pop_back();
    }
}

void TourSearch::apply(const Move& move) {
    for (const End end : {move.a, move.c, move.t}) {
        ask_again(link(end));
        ask_again(end);
    }
    if (move.is_exchange) {
        exchange(move.a, move.c);
    } else {
        move_block(move.a, move.c, move.t);
    }
}

// The block from c to t comes between a and its link: turned round in its place first, if it has to be, then by two
// exchanges, of which the first links t's end of it and the second the gap that it leaves.
void TourSearch::move_block(End a, End c, End t) {
    const End b = link(a);
    if (is_entry(a) != is_entry(c)) exchange(c, link(t));
    exchange(a, c);
    exchange(t, b);
}

// Links a with c, and what they were linked with. Both must be entries, or neither.
void TourSearch::exchange(End a, End c) {
    exchanges_.emplace_back(a, link(a));
    std::uint32_t first = position_[a / 2], last = position_[c / 2];
    if (is_entry(a)) {
        last = last == 0 ? count() - 1 : last - 1;
    } else {
        first = first + 1 == count() ? 0 : first + 1;
    }
    reverse(first, last);
}

// To turn the rest of the ring round comes to the same.
void TourSearch::reverse(std::uint32_t first, std::uint32_t last) {
    const std::uint32_t all = count();
    std::uint32_t length = (last + all - first) % all + 1;
    if (2 * length > all) {
        const std::uint32_t rest_first = last + 1 == all ? 0 : last + 1;
        last = first == 0 ? all - 1 : first - 1;
        first = rest_first;
        length = all - length;
    }
    for (; length > 0; length = length > 2 ? length - 2 : 0) {
        const End front = order_[first] ^ 1, back = order_[last] ^ 1;
        order_[first] = back;
        order_[last] = front;
        position_[back / 2] = first;
        position_[front / 2] = last;
        first = first + 1 == all ? 0 : first + 1;
        last = last == 0 ? all - 1 : last - 1;
    }
}

void TourSearch::ask_again(End end) {
    if (end == free_end() || is_asked_[end]) return;
    is_asked_[end] = true;
    asked_.push_back(end);
}

std::vector<Visit> TourSearch::visits() const {
    std::vector<Visit> visits;
    visits.reserve(closed_.size() - 1);
    for (End end = link(head_end()); end != free_end(); end = link(end ^ 1))
        visits.push_back({end / 2, end % 2 == 1 && !is_closed(end)});
    return visits;
}

}  // namespace lyr
