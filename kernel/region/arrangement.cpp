// All curves' ends and meetings become vertices, each curve is cut at the vertices that it passes, and what coincides
// is added up. Vertices do not move once they are there. A curve that bends to one stays within snap_mm of where it was,
// and what lies between is as a rule a vertex that it passes as well; where not, the sweep finds the edges that cross.

#include "kernel/region/arrangement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "kernel/region/box_tree.h"
#include "kernel/region/vertex_set.h"

namespace lyr::region {
namespace {

// A meeting counts if both curves pass it so near; round-off is far below, and with vertex_share it stays below 1.
constexpr double meeting_share = 0.4;

// Meetings at a smaller angle (its sine) come after the others: they are the less certain of where they are.
constexpr double shallow = 0.1;

// Where two sources meet.
struct Meeting {
    Point2 point;
    std::uint32_t a, b;
};

struct Passing {
    std::uint32_t vertex;
    bool bound;  // a meeting on this curve: it has to pass
    double along_mm = 0, across_mm = 0;
};

class Arranger {
public:
    Arranger(std::span<const Input> inputs, double snap_mm)
        : inputs_(inputs),
          snap_mm_(snap_mm),
          near_mm_(meeting_share * snap_mm),
          vertices_(snap_mm * vertex_share),
          result_{.sources = sources_of(inputs)},
          boxes_(boxes_of(result_.sources, snap_mm)),
          tree_(boxes_, BoxOrder::along_contours),
          passings_(result_.sources.size()) {}

    Arrangement result() {
        add_ends();
        add_meetings();
        make_edges();
        finish(vertices_.points(), snap_mm_, result_);
        return std::move(result_);
    }

private:
    static std::vector<Box2> boxes_of(std::span<const Source> sources, double margin_mm);

    std::uint32_t add_vertex(const Point2& point);
    void bind(std::uint32_t vertex, std::uint32_t a, std::uint32_t b);
    void add_ends();
    bool share_end_at(std::uint32_t a, std::uint32_t b, const Point2& point) const;
    void add_meetings();
    void add_meetings(std::uint32_t a, std::uint32_t b);
    void add_meeting(const Meeting& meeting);
    std::optional<std::uint32_t> common_vertex(std::uint32_t a, std::uint32_t b,
                                               const Point2& point) const;
    std::uint32_t within(std::uint32_t source, std::uint32_t vertex) const;
    bool is_on(std::uint32_t source, std::uint32_t vertex) const;
    std::vector<Passing> way_of(std::uint32_t source) const;
    void make_edges();
    void add_edge(std::uint32_t source, std::uint32_t from, std::uint32_t to, double sweep);

    std::span<const Input> inputs_;
    double snap_mm_, near_mm_;
    VertexSet vertices_;
    Arrangement result_;
    std::vector<Box2> boxes_;  // by source, grown by the snap
    BoxTree tree_;
    std::vector<std::uint32_t> starts_, ends_;    // vertices by source
    std::vector<std::vector<Passing>> passings_;  // by source, as they came
    std::vector<Meeting> shallow_;                // at small angles, for later
};

std::vector<Box2> Arranger::boxes_of(std::span<const Source> sources, double margin_mm) {
    const Vector2 margin(margin_mm, margin_mm);
    std::vector<Box2> boxes;
    for (const Source& source : sources) {
        const Box2 box = bounds_of(source.curve);
        boxes.push_back({box.min() - margin, box.max() + margin});
    }
    return boxes;
}

// With the curves that pass it.
std::uint32_t Arranger::add_vertex(const Point2& point) {
    const std::size_t before = vertices_.points().size();
    const std::uint32_t vertex = vertices_.add(point);
    if (vertex < before) return vertex;
    tree_.meeting(Box2(point), [&](std::uint32_t s) {
        const Curve& curve = result_.sources[s].curve;
        // Its own end is on its way as it is.
        if (point == curve.start || point == curve.end) return;
        if (std::abs(across_mm(curve, point)) <= snap_mm_ &&
            std::abs(along_mm(curve, point)) < curve.half_mm) {
            passings_[s].push_back({vertex, false});
        }
    });
    return vertex;
}

void Arranger::bind(std::uint32_t vertex, std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t source : {a, b}) passings_[source].push_back({vertex, true});
}

// Ends of segments come first, so that they stay where they are; then what the cuts into curves added.
void Arranger::add_ends() {
    const std::vector<Source>& sources = result_.sources;
    const auto same_segment = [](const Source& a, const Source& b) {
        return a.contour == b.contour && a.segment == b.segment;
    };
    starts_.resize(sources.size());
    for (const bool cuts : {false, true}) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
            const bool is_cut = i > 0 && same_segment(sources[i - 1], sources[i]);
            if (is_cut == cuts) starts_[i] = add_vertex(sources[i].curve.start);
        }
    }
    // A contour's curves are a ring: an end is the vertex that the next one starts from.
    ends_.resize(sources.size());
    for (std::size_t first = 0; first < sources.size();) {
        std::size_t last = first;
        while (last + 1 < sources.size() && sources[last + 1].contour == sources[first].contour) {
            ends_[last] = starts_[last + 1];
            ++last;
        }
        ends_[last] = starts_[first];
        first = last + 1;
    }
}

bool Arranger::is_on(std::uint32_t source, std::uint32_t vertex) const {
    const std::vector<Passing>& passings = passings_[source];
    return starts_[source] == vertex || ends_[source] == vertex ||
           std::any_of(passings.begin(), passings.end(),
                       [&](const Passing& passing) { return passing.vertex == vertex; });
}

// The nearest vertex that both pass so near to the point, or run so near to each other on the way to it, that meeting
// there will do.
std::optional<std::uint32_t> Arranger::common_vertex(std::uint32_t a, std::uint32_t b,
                                                     const Point2& point) const {
    // What one of them passes is looked at, of that which passes fewer.
    if (passings_[b].size() < passings_[a].size()) std::swap(a, b);
    const Curve &one = result_.sources[a].curve, &other = result_.sources[b].curve;
    const double here = along_mm(one, point);
    std::optional<std::uint32_t> best;
    double best_mm = std::numeric_limits<double>::infinity();
    const auto consider = [&](std::uint32_t vertex) {
        if (!is_on(b, vertex)) return;
        const double there = along_mm(one, vertices_.points()[vertex]);
        if (std::abs(there - here) < best_mm &&
            std::abs(across_mm(other, point_on(one, there))) <= snap_mm_ &&
            std::abs(across_mm(other, point_on(one, (here + there) / 2))) <= near_mm_) {
            best = vertex;
            best_mm = std::abs(there - here);
        }
    };
    consider(starts_[a]);
    consider(ends_[a]);
    for (const Passing& passing : passings_[a]) consider(passing.vertex);
    return best;
}

// The vertex, or the end of the curve that it lies beyond.
std::uint32_t Arranger::within(std::uint32_t source, std::uint32_t vertex) const {
    const Curve& curve = result_.sources[source].curve;
    const double along = along_mm(curve, vertices_.points()[vertex]);
    if (std::abs(along) < curve.half_mm) return vertex;
    return along < 0 ? starts_[source] : ends_[source];
}

void Arranger::add_meeting(const Meeting& meeting) {
    const std::uint32_t a = meeting.a, b = meeting.b;
    const auto common = common_vertex(a, b, meeting.point);
    std::uint32_t vertex = common ? *common : add_vertex(meeting.point);
    // What moved beyond an end is that end: a curve that went there would have to come back.
    for (const std::uint32_t source : {a, b}) vertex = within(source, vertex);
    bind(vertex, a, b);
}

bool Arranger::share_end_at(std::uint32_t a, std::uint32_t b, const Point2& point) const {
    const auto is_shared_end = [&](std::uint32_t vertex) {
        return (vertex == starts_[b] || vertex == ends_[b]) &&
               (vertices_.points()[vertex] - point).norm() <= near_mm_;
    };
    return is_shared_end(starts_[a]) || is_shared_end(ends_[a]);
}

void Arranger::add_meetings(std::uint32_t a, std::uint32_t b) {
    const Curve &one = result_.sources[a].curve, &other = result_.sources[b].curve;
    const Meetings found = meetings(one, other);
    for (int i = 0; i < found.count; ++i) {
        const Point2& point = found.points[static_cast<std::size_t>(i)];
        // Neighbours, as a rule: there is nothing to do.
        if (share_end_at(a, b, point)) continue;
        if (!passes(one, point, near_mm_) || !passes(other, point, near_mm_)) continue;
        const double sine = cross(tangent_beside(one, point), tangent_beside(other, point));
        if (std::abs(sine) < shallow) {
            shallow_.push_back({point, a, b});
        } else {
            add_meeting({point, a, b});
        }
    }
}

void Arranger::add_meetings() {
    std::vector<std::uint32_t> others;
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
        others.clear();
        tree_.meeting(boxes_[i], [&](std::uint32_t j) {
            if (j > i) others.push_back(j);
        });
        std::sort(others.begin(), others.end());
        for (const std::uint32_t j : others) add_meetings(i, j);
    }
    for (const Meeting& meeting : shallow_) add_meeting(meeting);
}

// The vertices between the ends in their order. Of two that lie side by side rather than one behind the other, a curve
// that passed both would run to and fro: it passes the nearer one, unless it has to pass both.
std::vector<Passing> Arranger::way_of(std::uint32_t source) const {
    const Curve& curve = result_.sources[source].curve;
    const std::uint32_t start = starts_[source], end = ends_[source];
    std::vector<Passing> way{{start, true, -curve.half_mm, 0}};
    std::vector<Passing> inner = passings_[source];
    for (Passing& passing : inner) {
        const Point2& point = vertices_.points()[passing.vertex];
        passing.along_mm = along_mm(curve, point);
        passing.across_mm = across_mm(curve, point);
    }
    std::erase_if(inner, [&](const Passing& p) {
        return p.vertex == start || p.vertex == end || !(std::abs(p.along_mm) < curve.half_mm);
    });
    std::sort(inner.begin(), inner.end(), [](const Passing& a, const Passing& b) {
        return std::tuple(a.along_mm, a.vertex, !a.bound) <
               std::tuple(b.along_mm, b.vertex, !b.bound);
    });
    inner.push_back({end, true, curve.half_mm, 0});
    for (const Passing& passing : inner) {
        if (passing.vertex == way.back().vertex) continue;
        const auto beside = [&](const Passing& other) {
            return std::abs(passing.across_mm - other.across_mm) >
                   passing.along_mm - other.along_mm;
        };
        const auto farther = [&](const Passing& other) {
            return std::abs(other.across_mm) > std::abs(passing.across_mm);
        };
        while (!way.back().bound && beside(way.back()) && (passing.bound || farther(way.back()))) {
            way.pop_back();
        }
        if (passing.bound || !beside(way.back())) way.push_back(passing);
    }
    return way;
}

void Arranger::add_edge(std::uint32_t source, std::uint32_t from, std::uint32_t to, double sweep) {
    if (from == to) return;
    const std::vector<Point2>& points = vertices_.points();
    const double sagitta =
        sweep == 0 ? 0 : arc_with_sweep(points[from], points[to], sweep).sagitta_mm;
    const std::uint32_t contour = result_.sources[source].contour;
    result_.edges.push_back(
        {from, to, sagitta, sweep, Winding{} - inputs_[contour].weight, source, true});
    ++result_.steps[contour];
}

void Arranger::make_edges() {
    result_.steps.assign(inputs_.size(), 0);
    for (std::uint32_t s = 0; s < result_.sources.size(); ++s) {
        const double k = result_.sources[s].curve.curvature_per_mm;
        if (passings_[s].empty()) {
            add_edge(s, starts_[s], ends_[s], k * 2 * result_.sources[s].curve.half_mm);
            continue;
        }
        const std::vector<Passing> way = way_of(s);
        for (std::size_t i = 1; i < way.size(); ++i) {
            add_edge(s, way[i - 1].vertex, way[i].vertex,
                     k * (way[i].along_mm - way[i - 1].along_mm));
        }
    }
}

}  // namespace

std::vector<Source> sources_of(std::span<const Input> inputs) {
    std::vector<Source> sources;
    for (std::uint32_t i = 0; i < inputs.size(); ++i) {
        for_monotone_curves(*inputs[i].contour, [&](const Curve& curve, std::size_t segment) {
            sources.push_back({curve, i, static_cast<std::uint32_t>(segment)});
        });
    }
    return sources;
}

Arrangement arranged(std::span<const Input> inputs, double snap_mm) {
    return Arranger(inputs, snap_mm).result();
}

}  // namespace lyr::region
