#include "kernel/region/stitch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kernel/region/sliver.h"

namespace lyr::region {
namespace {

// Wider arcs are left to simplified(): their chord may be too short to say where the circle is.
constexpr double widest_run_rad = std::numbers::pi;

class Stitcher {
public:
    Stitcher(std::span<const Input> inputs, const Arrangement& arrangement, const Sweep& sweep,
             double join_mm, double sliver_mm)
        : inputs_(inputs),
          graph_(arrangement),
          edges_(sweep.edges),
          join_mm_(join_mm),
          sliver_mm_(sliver_mm) {}

    Stitched result() {
        std::vector<bool> done(edges_.size(), false);
        place_on_way_.assign(graph_.vertices.size(), none);
        for (std::uint32_t first = 0; first < edges_.size(); ++first) {
            if (!edges_[first].kept || done[first]) continue;
            for (std::uint32_t e = first; !done[e]; e = edges_[e].next) {
                done[e] = true;
                step(e);
            }
            finish(0);
        }
        return std::move(result_);
    }

private:
    using Loop = std::span<const std::uint32_t>;

    std::uint32_t from(std::uint32_t e) const {
        return edges_[e].rises ? edges_[e].low : edges_[e].high;
    }
    std::uint32_t to(std::uint32_t e) const {
        return edges_[e].rises ? edges_[e].high : edges_[e].low;
    }
    bool along(std::uint32_t e) const { return edges_[e].along == edges_[e].rises; }
    const Source& source(std::uint32_t e) const { return graph_.sources[edges_[e].source]; }

    bool same_run(std::uint32_t a, std::uint32_t b) const {
        return source(a).contour == source(b).contour && source(a).segment == source(b).segment &&
               along(a) == along(b);
    }

    void step(std::uint32_t e);
    void finish(std::size_t first);
    bool is_whole_input(Loop loop) const;
    void build(Loop loop);
    std::optional<Segment> whole_segment(Loop run) const;
    void add_run(Loop run, Path& path) const;

    std::span<const Input> inputs_;
    const Arrangement& graph_;
    const std::vector<SweptEdge>& edges_;
    double join_mm_, sliver_mm_;
    std::vector<std::uint32_t> way_;           // edges walked and not yet in a contour
    std::vector<std::uint32_t> place_on_way_;  // by vertex: of the edge that leaves it
    Stitched result_;
};

// Back at a vertex of the way: what was walked since is a contour.
void Stitcher::step(std::uint32_t e) {
    if (const std::uint32_t seen = place_on_way_[from(e)]; seen != none) finish(seen);
    place_on_way_[from(e)] = static_cast<std::uint32_t>(way_.size());
    way_.push_back(e);
}

void Stitcher::finish(std::size_t first) {
    const Loop loop = Loop(way_).subspan(first);
    if (is_whole_input(loop)) {
        result_.whole.push_back({source(loop.front()).contour, !along(loop.front())});
    } else {
        build(loop);
    }
    for (const std::uint32_t e : loop) place_on_way_[from(e)] = none;
    way_.resize(first);
}

bool Stitcher::is_whole_input(Loop loop) const {
    const std::uint32_t contour = source(loop.front()).contour;
    const bool direction = along(loop.front());
    return loop.size() == graph_.steps[contour] &&
           std::all_of(loop.begin(), loop.end(), [&](std::uint32_t e) {
               return source(e).contour == contour && along(e) == direction;
           });
}

// The input's segment if these edges are all of it, in either direction.
std::optional<Segment> Stitcher::whole_segment(Loop run) const {
    const Source& of = source(run.front());
    const auto* path = std::get_if<Path>(inputs_[of.contour].contour);
    if (!path) return std::nullopt;
    const Segment& whole = path->segments[of.segment];
    const Point2& begin = of.segment == 0 ? path->start : path->segments[of.segment - 1].end;
    const Point2 &start = graph_.vertices[from(run.front())],
                 &end = graph_.vertices[to(run.back())];
    if (along(run.front()) && start == begin && end == whole.end) return whole;
    if (!along(run.front()) && start == whole.end && end == begin) {
        return Segment{begin, -whole.sagitta_mm};
    }
    return std::nullopt;
}

// Edges that follow each other along one segment, in as few pieces as are sure of their circle.
void Stitcher::add_run(Loop run, Path& path) const {
    if (const auto whole = whole_segment(run)) return path.segments.push_back(*whole);
    const auto sweep_of = [&](std::uint32_t e) {
        return edges_[e].rises ? edges_[e].sweep_rad : -edges_[e].sweep_rad;
    };
    Point2 start = graph_.vertices[from(run.front())];
    for (std::size_t first = 0; first < run.size();) {
        double sweep = sweep_of(run[first]);
        std::size_t last = first + 1;
        for (; last < run.size(); ++last) {
            if (std::abs(sweep + sweep_of(run[last])) > widest_run_rad) break;
            sweep += sweep_of(run[last]);
        }
        const Point2& end = graph_.vertices[to(run[last - 1])];
        path.segments.push_back(sweep == 0 ? Segment{end} : arc_with_sweep(start, end, sweep));
        start = end;
        first = last;
    }
}

void Stitcher::build(Loop loop) {
    // Begins where a run begins, if there is more than one.
    std::vector<std::uint32_t> edges(loop.begin(), loop.end());
    for (std::size_t i = 1; i < edges.size(); ++i) {
        if (same_run(edges[i - 1], edges[i])) continue;
        std::rotate(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(i), edges.end());
        break;
    }
    Path path{graph_.vertices[from(edges.front())], {}};
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t last = first + 1;
        while (last < edges.size() && same_run(edges[first], edges[last])) ++last;
        add_run(Loop(edges).subspan(first, last - first), path);
        first = last;
    }
    const auto contour = simplified(std::move(path), join_mm_);
    if (contour && !is_sliver(*contour, sliver_mm_)) {
        result_.built.push_back(*contour);
    } else {
        ++result_.slivers;
    }
}

}  // namespace

Stitched stitched(std::span<const Input> inputs, const Arrangement& arrangement, const Sweep& sweep,
                  double join_mm, double sliver_mm) {
    return Stitcher(inputs, arrangement, sweep, join_mm, sliver_mm).result();
}

}  // namespace lyr::region
