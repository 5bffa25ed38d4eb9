#include "kernel/region/sweep.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/tolerance.h"

namespace lyr::region {
namespace {

class Sweeper {
public:
    Sweeper(const Arrangement& arrangement, const Inside& inside, double snap_mm)
        : points_(arrangement.vertices),
          inside_(inside),
          snap_mm_(snap_mm),
          given_(arrangement.edges.size()),
          ending_(points_.size(), 0) {
        for (const Edge& edge : arrangement.edges) {
            edges_.push_back({edge});
            ++ending_[edge.high];
        }
    }

    Sweep result() {
        std::uint32_t next = 0;
        for (std::uint32_t v = 0; v < points_.size(); ++v) {
            starting_.clear();
            for (; next < given_ && edges_[next].low == v; ++next) starting_.push_back(next);
            if (!starting_.empty() || ending_[v] > 0) pass(v);
        }
        return {std::move(edges_), contradictions_, std::move(crossings_), worst_detour_mm_};
    }

private:
    struct Place {
        std::size_t first, last;
    };

    int side(const SweptEdge& edge, std::uint32_t vertex) const;
    bool starts_left_of(std::uint32_t a, std::uint32_t b) const;
    Place place_of(std::uint32_t vertex) const;
    void lead_through(std::uint32_t vertex, std::uint32_t edge);
    void wind(const Winding& from_left);
    void link();
    void compare(std::size_t right);
    void add_crossing(std::uint32_t a, std::uint32_t b, std::uint32_t top);
    void pass(std::uint32_t vertex);

    const std::vector<Point2>& points_;
    const Inside& inside_;
    double snap_mm_;
    std::size_t given_;  // edges; those behind are parts of edges that were led through a vertex
    std::vector<std::uint32_t> ending_;  // by vertex, how many edges end there
    std::vector<SweptEdge> edges_;
    std::vector<std::uint32_t> status_;            // from left to right
    std::vector<std::uint32_t> ended_, starting_;  // at the vertex that is being passed
    std::vector<std::uint32_t> around_;            // scratch of link()
    std::size_t contradictions_ = 0;
    std::vector<Contact> crossings_;
    double worst_detour_mm_ = 0;
};

// Of a vertex in the edge's height: -1 left of the edge, 1 right of it, 0 for its own upper end.
int Sweeper::side(const SweptEdge& edge, std::uint32_t vertex) const {
    if (edge.high == vertex) return 0;
    const Point2 &low = points_[edge.low], &high = points_[edge.high], &point = points_[vertex];
    const double right = cross(point - low, high - low);
    // An arc with positive sagitta is right of its chord: what is left of that is left of both.
    if (edge.sagitta_mm > 0 && right <= 0) return -1;
    if (edge.sagitta_mm < 0 && right >= 0) return 1;
    const double off =
        edge.sagitta_mm == 0 ? right : offset_mm(low, {high, edge.sagitta_mm}, point);
    return off > 0 ? 1 : -1;
}

// Of two edges from one vertex. They are apart at the first of their ends, where the arrangement knows of no contact.
bool Sweeper::starts_left_of(std::uint32_t a, std::uint32_t b) const {
    const SweptEdge &one = edges_[a], &other = edges_[b];
    if (one.high == other.high) return one.sagitta_mm < other.sagitta_mm;
    return one.high < other.high ? side(other, one.high) < 0 : side(one, other.high) > 0;
}

// Where the edges that end in the vertex are in the status, with all that lie between them; if there are none, where
// the vertex belongs.
Sweeper::Place Sweeper::place_of(std::uint32_t vertex) const {
    std::size_t low = 0, high = status_.size();
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        const int where = side(edges_[status_[middle]], vertex);
        if (where == 0) {
            low = middle;
            break;
        }
        (where > 0 ? low : high) = where > 0 ? middle + 1 : middle;
    }
    Place place{low, low};
    std::size_t left = low, right = low;
    std::uint32_t missing = ending_[vertex];
    const auto take = [&](std::size_t at) {
        if (edges_[status_[at]].high != vertex) return;
        place = missing == ending_[vertex]
                    ? Place{at, at + 1}
                    : Place{std::min(place.first, at), std::max(place.last, at + 1)};
        --missing;
    };
    // Outwards on both sides: as a rule they lie side by side, just here.
    while (missing > 0 && (left > 0 || right < status_.size())) {
        if (right < status_.size()) take(right++);
        if (missing > 0 && left > 0) take(--left);
    }
    return place;
}

void Sweeper::lead_through(std::uint32_t vertex, std::uint32_t index) {
    SweptEdge upper = edges_[index];
    const Segment shape{points_[upper.high], upper.sagitta_mm};
    const double off = offset_mm(points_[upper.low], shape, points_[vertex]);
    worst_detour_mm_ = std::max(worst_detour_mm_, std::abs(off));
    // The sweep is shared out as the chords are; exact for a line, and what is off is of the detour's own order.
    const double below = (points_[vertex] - points_[upper.low]).norm();
    const double above = (points_[upper.high] - points_[vertex]).norm();
    SweptEdge& lower = edges_[index];
    lower.high = upper.low = vertex;
    lower.sweep_rad *= below / (below + above);
    upper.sweep_rad *= above / (below + above);
    for (SweptEdge* edge : {&lower, &upper}) {
        if (edge->sweep_rad == 0) continue;
        edge->sagitta_mm =
            arc_with_sweep(points_[edge->low], points_[edge->high], edge->sweep_rad).sagitta_mm;
    }
    starting_.push_back(static_cast<std::uint32_t>(edges_.size()));
    edges_.push_back(upper);
}

// The windings of the edges that start here.
void Sweeper::wind(const Winding& from_left) {
    Winding winding = from_left;
    for (const std::uint32_t e : starting_) {
        SweptEdge& edge = edges_[e];
        edge.left = winding;
        edge.right = winding = winding + edge.change;
        edge.rises = inside_(edge.left);
        edge.kept = edge.rises != inside_(edge.right);
    }
}

// Once around the vertex, counter-clockwise: what starts from right to left, what ended from left to right. Two kept
// edges with the inside between them follow each other on the boundary: it comes in on the second, out on the first.
void Sweeper::link() {
    around_.clear();
    for (auto e = starting_.rbegin(); e != starting_.rend(); ++e) {
        if (edges_[*e].kept) around_.push_back(*e);
    }
    const std::size_t above = around_.size();
    for (const std::uint32_t e : ended_) {
        if (edges_[e].kept) around_.push_back(e);
    }
    for (std::size_t i = 0; i < around_.size(); ++i) {
        // A rising edge has the inside on its left, which follows it here if the edge starts, not if it ended.
        const bool leaves = edges_[around_[i]].rises == (i < above);
        if (leaves) edges_[around_[(i + 1) % around_.size()]].next = around_[i];
    }
}

void Sweeper::add_crossing(std::uint32_t a, std::uint32_t b, std::uint32_t top) {
    const Curve one = shape_of(edges_[a], points_), other = shape_of(edges_[b], points_);
    const Meetings found = meetings(one, other);
    const auto add = [&](const Point2& point, double within_mm) {
        if (!passes(one, point, within_mm) || !passes(other, point, within_mm)) return false;
        crossings_.push_back({point, a, b});
        return true;
    };
    bool found_any = false;
    for (int i = 0; i < found.count; ++i) {
        found_any |= add(found.points[static_cast<std::size_t>(i)], resolution_mm);
    }
    // Perhaps they meet so near to an end that it cannot be computed; or a flat arc dips below its end, and below the
    // other's, by less than the snap.
    if (found_any) return;
    for (const std::uint32_t end : {edges_[a].low, edges_[b].low, top}) add(points_[end], snap_mm_);
}

// The edge at a place of the status with the one to its left.
void Sweeper::compare(std::size_t right) {
    if (right == 0 || right >= status_.size()) return;
    const std::uint32_t a = status_[right - 1], b = status_[right];
    const SweptEdge &one = edges_[a], &other = edges_[b];
    if (one.high == other.high) return;
    const std::uint32_t top = std::min(one.high, other.high);
    if (top == one.high ? side(other, top) <= 0 : side(one, top) >= 0) return;
    ++contradictions_;
    if (a < given_ && b < given_) add_crossing(a, b, top);
}

void Sweeper::pass(std::uint32_t vertex) {
    const Place place = place_of(vertex);
    ended_.assign(status_.begin() + static_cast<std::ptrdiff_t>(place.first),
                  status_.begin() + static_cast<std::ptrdiff_t>(place.last));
    for (const std::uint32_t e : ended_) {
        if (edges_[e].high != vertex) lead_through(vertex, e);
    }
    // Insertion: few edges start in one vertex, and an order that contradicts itself does no harm here.
    for (std::size_t i = 1; i < starting_.size(); ++i) {
        for (std::size_t j = i; j > 0 && starts_left_of(starting_[j], starting_[j - 1]); --j) {
            std::swap(starting_[j], starting_[j - 1]);
        }
    }
    wind(place.first == 0 ? Winding{} : edges_[status_[place.first - 1]].right);
    link();
    const auto at = status_.begin() + static_cast<std::ptrdiff_t>(place.first);
    const std::size_t replaced = std::min(ended_.size(), starting_.size());
    std::copy_n(starting_.begin(), replaced, at);
    if (replaced < ended_.size()) {
        status_.erase(at + static_cast<std::ptrdiff_t>(replaced),
                      at + static_cast<std::ptrdiff_t>(ended_.size()));
    } else {
        status_.insert(at + static_cast<std::ptrdiff_t>(replaced),
                       starting_.begin() + static_cast<std::ptrdiff_t>(replaced), starting_.end());
    }
    for (std::size_t i = 0; i <= starting_.size(); ++i) compare(place.first + i);
}

}  // namespace

Sweep swept(const Arrangement& arrangement, const Inside& inside, double snap_mm) {
    return Sweeper(arrangement, inside, snap_mm).result();
}

}  // namespace lyr::region
