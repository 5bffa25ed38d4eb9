// Branches are taken off in rounds: once those into a bump's corners are gone, the bump itself is a branch that may be.
// What ends in no branching is never taken off.

#include "kernel/toolpath/medial_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lyr {
namespace {

// By how much of a disc's radius a branch has to stick out of it.
constexpr double stick_out_share = 1;

class Graph {
public:
    Graph(const MedialAxis& axis, double min_width_mm, const Boundary* covered)
        : edges_(axis.edges), least_mm_(min_width_mm / 2), covered_(covered) {
        const auto count = static_cast<End>(2 * edges_.size());
        std::vector<End> order(count);
        for (End end = 0; end < count; ++end) order[end] = end;
        std::sort(order.begin(), order.end(), [&](End a, End b) {
            const Point2 &p = point(a).centre, &q = point(b).centre;
            return std::tuple(p.x(), p.y(), a) < std::tuple(q.x(), q.y(), b);
        });
        node_.resize(count);
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i == 0 || point(order[i]).centre != point(order[i - 1]).centre) at_.emplace_back();
            node_[order[i]] = static_cast<Node>(at_.size() - 1);
            at_.back().push_back(order[i]);
        }
    }

    void prune() {
        while (prune_round()) {
        }
    }

    std::vector<MedialChain> chains() {
        link_.assign(node_.size(), none);
        for (const std::vector<End>& ends : at_) join(ends);
        std::vector<bool> is_taken(edges_.size(), false);
        std::vector<MedialChain> result;
        for (const bool closed : {false, true})
            for (End end = 0; end < node_.size(); ++end)
                if (is_alive(end) && !is_taken[end / 2] && (closed || link_[end] == none))
                    result.push_back(chain(end, is_taken));
        return result;
    }

private:
    // Of an edge e, 2 e is the start and 2 e + 1 the end.
    using End = std::uint32_t;
    using Node = std::uint32_t;
    static constexpr End none = std::numeric_limits<End>::max();

    struct Branch {
        std::vector<std::uint32_t> edges;
        End last;  // at the branching
        double stick_out_mm;
    };

    const MedialPoint& point(End end) const {
        const std::vector<MedialPoint>& points = edges_[end / 2].points;
        return end % 2 == 0 ? points.front() : points.back();
    }
    Vector2 direction(End end) const {
        return end % 2 == 0 ? point(end).tangent : Vector2(-point(end).tangent);
    }
    MedialEdge edge_from(End end) const {
        return end % 2 == 0 ? edges_[end / 2] : reversed(edges_[end / 2]);
    }
    std::size_t degree(End end) const { return at_[node_[end]].size(); }
    bool is_alive(End end) const {
        const std::vector<End>& ends = at_[node_[end]];
        return std::find(ends.begin(), ends.end(), end) != ends.end();
    }
    End next(End arrived) const {
        const std::vector<End>& ends = at_[node_[arrived]];
        return ends[0] == arrived ? ends[1] : ends[0];
    }

    // As far as discs along an edge are wide enough.
    double wide_length_mm(const MedialEdge& edge) const {
        double length = 0;
        for (std::size_t i = 1; i < edge.points.size(); ++i) {
            const MedialPoint &a = edge.points[i - 1], &b = edge.points[i];
            const double low = std::min(a.radius_mm, b.radius_mm);
            const double high = std::max(a.radius_mm, b.radius_mm);
            const double share = low >= least_mm_    ? 1
                                 : high <= least_mm_ ? 0
                                                     : (high - least_mm_) / (high - low);
            length += share * (b.centre - a.centre).norm();
        }
        return length;
    }

    Branch branch(End tip) const {
        Branch result{{}, tip, std::max(point(tip).radius_mm, least_mm_)};
        for (End from = tip;;) {
            result.edges.push_back(from / 2);
            result.stick_out_mm += wide_length_mm(edges_[from / 2]);
            result.last = from ^ 1U;
            if (degree(result.last) != 2 || result.edges.size() > edges_.size()) break;
            from = next(result.last);
        }
        result.stick_out_mm -= point(result.last).radius_mm;
        return result;
    }

    bool is_covered(End end) const { return covered_ && covered_->winding(point(end).centre) > 0; }

    bool prune_round() {
        std::vector<std::vector<Branch>> branches(at_.size());  // by where they branch off
        for (End end = 0; end < node_.size(); ++end) {
            if (!is_alive(end) || degree(end) != 1) continue;
            Branch found = branch(end);
            const double radius = point(found.last).radius_mm;
            if (degree(found.last) < 3 || radius < least_mm_ ||
                found.stick_out_mm >= stick_out_share * radius || is_covered(found.last))
                continue;
            branches[node_[found.last]].push_back(std::move(found));
        }
        bool pruned = false;
        for (Node node = 0; node < at_.size(); ++node) {
            std::vector<Branch>& list = branches[node];
            std::stable_sort(list.begin(), list.end(), [](const Branch& a, const Branch& b) {
                return a.stick_out_mm < b.stick_out_mm;
            });
            // Where nothing else is, the two longest stay.
            const std::size_t keep = list.size() == at_[node].size() ? 2 : 0;
            for (std::size_t i = 0; i + keep < list.size(); ++i) remove(list[i].edges);
            pruned = pruned || list.size() > keep;
        }
        return pruned;
    }

    void remove(const std::vector<std::uint32_t>& edges) {
        for (const std::uint32_t edge : edges)
            for (const End end : {2 * edge, 2 * edge + 1}) std::erase(at_[node_[end]], end);
    }

    // Links the two ends that are most nearly in line.
    void join(const std::vector<End>& ends) {
        double best = std::numeric_limits<double>::infinity();
        End first = none, second = none;
        for (std::size_t i = 0; i < ends.size(); ++i)
            for (std::size_t j = i + 1; j < ends.size(); ++j) {
                const double bend = direction(ends[i]).dot(direction(ends[j]));
                if (!(bend < best)) continue;
                best = bend;
                first = ends[i];
                second = ends[j];
            }
        if (first == none) return;
        link_[first] = second;
        link_[second] = first;
    }

    MedialChain chain(End start, std::vector<bool>& is_taken) const {
        MedialChain result;
        result.starts_at_branch = link_[start] == none && degree(start) > 1;
        for (End from = start; from != none && !is_taken[from / 2]; from = link_[from ^ 1U]) {
            is_taken[from / 2] = true;
            result.edges.push_back(edge_from(from));
            result.is_closed = link_[from ^ 1U] == start;
            result.ends_at_branch = link_[from ^ 1U] == none && degree(from ^ 1U) > 1;
        }
        return result;
    }

    const std::vector<MedialEdge>& edges_;
    double least_mm_;
    const Boundary* covered_;
    std::vector<Node> node_;            // by end
    std::vector<std::vector<End>> at_;  // by node: the ends there that are left
    std::vector<End> link_;             // by end
};

}  // namespace

std::vector<MedialChain> medial_chains(const MedialAxis& axis, double min_width_mm,
                                       const Boundary* covered) {
    Graph graph(axis, min_width_mm, covered);
    graph.prune();
    return graph.chains();
}

}  // namespace lyr
