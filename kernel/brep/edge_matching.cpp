// Candidates come from the places of ends, then curves are compared along; what is left to choose is chosen last.

#include "kernel/brep/edge_matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "kernel/brep/edge_splitting.h"
#include "kernel/brep/point_index.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// Where edges are compared between their ends: shares of the way, unevenly spread, for shapes repeat evenly.
constexpr std::array<double, 5> compared_at{0.13, 0.31, 0.52, 0.71, 0.89};

struct Candidate {
    std::uint32_t a, b;  // among the free edges, a < b
    bool same_direction;
    double gap_mm;
    int distance;  // of the faces in the model: 0 in one shell, 1 in one solid, 2 in different surfaces
};

// The greatest distance of points along one edge from another that runs the same way or the other; none if they part.
std::optional<double> gap_along(const Edge& from, const Edge& to, bool same_direction,
                                double reach_mm) {
    if (std::holds_alternative<Line>(from.curve) && std::holds_alternative<Line>(to.curve)) {
        return 0;  // their ends say it all
    }
    double gap = 0, last = -1;
    for (const double share : compared_at) {
        const Point3 point = point_on(from, share);
        const double t = nearest_parameter(to, point);
        gap = std::max(gap, (evaluate(to.curve, t) - point).norm());
        const double along = (t - to.t_start) / (to.t_end - to.t_start);
        const double forward = same_direction ? along : 1 - along;
        if (!(gap <= reach_mm) || forward < last) return std::nullopt;
        last = forward;
    }
    return gap;
}

class Matcher {
public:
    Matcher(const Model& model, const std::vector<FreeEdge>& free, double reach_mm,
            FaceParity& parity)
        : model_(model), free_(free), reach_mm_(reach_mm), parity_(parity) {
        find_candidates();
        std::sort(candidates_.begin(), candidates_.end(), [](const auto& a, const auto& b) {
            return std::tie(a.distance, a.gap_mm, a.a, a.b, a.same_direction) <
                   std::tie(b.distance, b.gap_mm, b.a, b.b, b.same_direction);
        });
        is_taken_.assign(free.size(), false);
    }

    std::vector<EdgePair> pairs() {
        for (const int distance : {0, 1, 2}) {
            take_nearest_by_far(distance);
            // Each pair may make others agree or contradict; first those that hold their faces together anyway.
            take_agreeing(distance, true);
            take_agreeing(distance, false);
        }
        return std::move(pairs_);
    }

private:
    // Ends are numbered: twice the edge's number, and one more at its end.
    void find_candidates() {
        std::vector<Point3> ends;
        for (const FreeEdge& free : free_) {
            ends.push_back(model_[model_[free.edge].start].point);
            ends.push_back(model_[model_[free.edge].end].point);
        }
        const PointIndex index(ends);
        for (std::uint32_t a = 0; a < free_.size(); ++a) {
            index.within(box_around(ends[2 * a], reach_mm_), [&](std::uint32_t end) {
                const std::uint32_t b = end / 2;
                if (b <= a || !may_meet(model_, free_[a], free_[b])) return;
                const bool same_direction = end % 2 == 0;
                const double gap = std::max((ends[2 * a] - ends[end]).norm(),
                                            (ends[2 * a + 1] - ends[end ^ 1]).norm());
                if (gap <= reach_mm_) compare(a, b, same_direction, gap);
            });
        }
    }

    void compare(std::uint32_t a, std::uint32_t b, bool same_direction, double gap_mm) {
        const Edge &one = model_[free_[a].edge], &other = model_[free_[b].edge];
        const auto there = gap_along(one, other, same_direction, reach_mm_);
        if (!there) return;
        const auto back = gap_along(other, one, same_direction, reach_mm_);
        if (!back) return;
        const FaceId face_a = free_[a].face, face_b = free_[b].face;
        const int distance =
            model_[face_a].shell == model_[face_b].shell                               ? 0
            : model_[model_[face_a].shell].solid == model_[model_[face_b].shell].solid ? 1
                                                                                       : 2;
        candidates_.push_back({a, b, same_direction, std::max({gap_mm, *there, *back}), distance});
    }

    bool is_open(const Candidate& c) const { return !is_taken_[c.a] && !is_taken_[c.b]; }

    // Uses of the common edge in opposite directions.
    bool agree(const Candidate& c) const {
        return (free_[c.a].reversed == free_[c.b].reversed) != c.same_direction;
    }

    void take(const Candidate& c) {
        is_taken_[c.a] = is_taken_[c.b] = true;
        pairs_.push_back({free_[c.a], free_[c.b], c.same_direction, c.gap_mm});
    }

    // Pairs of which neither edge has another candidate that is comparably near.
    void take_nearest_by_far(int distance) {
        constexpr double by_far = 10;
        std::vector<const Candidate*> best(free_.size(), nullptr);
        std::vector<bool> has_rival(free_.size(), false);
        for (const Candidate& c : candidates_) {
            if (c.distance > distance || !is_open(c)) continue;
            for (const std::uint32_t edge : {c.a, c.b}) {
                if (best[edge] == nullptr) {
                    best[edge] = &c;
                } else if (c.gap_mm <= by_far * best[edge]->gap_mm + resolution_mm) {
                    has_rival[edge] = true;
                }
            }
        }
        for (const Candidate& c : candidates_) {
            if (best[c.a] != &c || best[c.b] != &c || has_rival[c.a] || has_rival[c.b]) continue;
            if (!is_open(c)) continue;
            take(c);
            parity_.join(free_[c.a].face, free_[c.b].face, agree(c));
        }
    }

    void take_agreeing(int distance, bool only_within_group) {
        for (const Candidate& c : candidates_) {
            if (c.distance > distance || !is_open(c)) continue;
            const FaceId a = free_[c.a].face, b = free_[c.b].face;
            if (only_within_group && parity_.root(a) != parity_.root(b)) continue;
            if (parity_.join(a, b, agree(c))) take(c);
        }
    }

    const Model& model_;
    const std::vector<FreeEdge>& free_;
    double reach_mm_;
    FaceParity& parity_;
    std::vector<Candidate> candidates_;
    std::vector<bool> is_taken_;
    std::vector<EdgePair> pairs_;
};

}  // namespace

std::vector<EdgePair> matching_edges(const Model& model, const std::vector<FreeEdge>& free,
                                     double reach_mm, FaceParity& parity) {
    return Matcher(model, free, reach_mm, parity).pairs();
}

}  // namespace lyr
