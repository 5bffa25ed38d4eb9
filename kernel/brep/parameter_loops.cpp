// Every node is the foot of an edge's point, found near the foot before it; its step is the edge's, resolved along
// d/du and d/dv.

#include "kernel/brep/parameter_loops.h"

#include <algorithm>
#include <cmath>

#include "kernel/brep/free_edges.h"
#include "kernel/brep/surface_foot.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

std::vector<double> edge_borders(const Edge& edge, const Fineness& fineness) {
    const double from = std::min(edge.t_start, edge.t_end), to = std::max(edge.t_start, edge.t_end);
    std::vector<double> knots;
    if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
        knots = spline->knots;
    } else if (!std::holds_alternative<Line>(edge.curve)) {
        const double widest = fineness.widest_rad;
        for (double t = from + widest; t < to; t += widest) knots.push_back(t);
    }
    return panel_borders(knots, from, to, fineness);
}

class Tracker {
public:
    Tracker(const BSplineSurface& surface, double closeness_mm, const Fineness& fineness)
        : surface_(surface),
          fineness_(fineness),
          period_(periods_of(surface)),
          closeness_mm_(closeness_mm),
          foot_(surface) {
        for (const bool along_u : {true, false}) {
            for (const bool at_end : {true, false}) {
                if (const auto pole = pole_of(surface, along_u, at_end)) poles_.push_back(*pole);
            }
        }
    }

    ParameterLoop loop(const Model& model, const Loop& loop) {
        ParameterLoop result;
        foot_ = SurfaceFoot(surface_);
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            const Coedge& use = model.coedges[c];
            for (const Point3& pole : poles_) {
                if ((model[model.start_of(use)].point - pole).norm() > closeness_mm_) continue;
                result.passages.push_back({result.nodes.size(), pole});
            }
            if (!append_known(use, result)) append(model[use.edge], use, result);
        }
        return result;
    }

private:
    // One coedge's, numbered by themselves.
    struct Stretch {
        Coedge use;
        std::vector<ParameterNode> nodes;
        std::vector<PolePassage> passages;
    };

    void append(const Edge& edge, const Coedge& use, ParameterLoop& loop) {
        std::vector<double> borders = edge_borders(edge, fineness_);
        if (use.reversed != (edge.t_end < edge.t_start)) {
            std::reverse(borders.begin(), borders.end());
        }
        Stretch stretch{use, {}, {}};
        std::vector<double> parameters;
        const std::size_t first = loop.nodes.size();
        for (std::size_t panel = 0; panel + 1 < borders.size(); ++panel) {
            const double width = borders[panel + 1] - borders[panel];
            for (std::size_t g = 0; g < gauss_at.size(); ++g) {
                const double t = borders[panel] + gauss_at[g] * width;
                const Vector3 step = gauss_weight[g] * width * derivative(edge.curve, t);
                move_to(evaluate(edge.curve, t), loop.nodes.empty());
                append({foot_.uv(), parameter_step(foot_.partials(), step)}, loop.nodes);
                stretch.nodes.push_back(loop.nodes.back());
                parameters.push_back(t);
            }
        }
        for (const Point3& pole : poles_) {
            const double t = nearest_parameter(edge, pole);
            const auto is_pole = [&](double at) {
                return (evaluate(edge.curve, at) - pole).norm() <= closeness_mm_;
            };
            if (!is_pole(t) || is_pole(edge.t_start) || is_pole(edge.t_end)) continue;
            const bool rises = borders.front() < borders.back();
            const auto before = std::count_if(parameters.begin(), parameters.end(),
                                              [&](double node) { return (node < t) == rises; });
            stretch.passages.push_back({static_cast<std::size_t>(before), pole});
            loop.passages.push_back({first + static_cast<std::size_t>(before), pole});
        }
        stretches_.push_back(std::move(stretch));
    }

    void append(ParameterNode node, std::vector<ParameterNode>& nodes) const {
        if (!nodes.empty()) node.uv = followed(node.uv, nodes.back().uv, period_);
        nodes.push_back(node);
    }

    // The way back along a seam needs no search.
    bool append_known(const Coedge& use, ParameterLoop& loop) const {
        for (const Stretch& known : stretches_) {
            if (known.use.edge != use.edge || known.use.reversed == use.reversed) continue;
            const std::size_t last = loop.nodes.size() + known.nodes.size();
            for (auto node = known.nodes.rbegin(); node != known.nodes.rend(); ++node) {
                append({node->uv, -node->step}, loop.nodes);
            }
            for (const PolePassage& passage : known.passages) {
                loop.passages.push_back({last - passage.next_node, passage.pole});
            }
            return true;
        }
        return false;
    }

    // A foot as far off as neighbours are apart is another place's neighbour.
    void move_to(const Point3& point, bool is_first) {
        constexpr double doubtful_share = 0.125;
        const double step_mm = is_first ? 0 : (point - point_).norm();
        point_ = point;
        foot_.move_to(point,
                      std::max({2 * foot_.distance_mm(), closeness_mm_, doubtful_share * step_mm}));
    }

    const BSplineSurface& surface_;
    Fineness fineness_;
    Vector2 period_;
    double closeness_mm_;
    SurfaceFoot foot_;
    Point3 point_ = Point3::Zero();  // that it is the foot of
    std::vector<Point3> poles_;
    std::vector<Stretch> stretches_;
};

}  // namespace

std::optional<Point3> pole_of(const BSplineSurface& s, bool along_u, bool at_end) {
    const std::size_t count = along_u ? s.count_u : s.count_v;
    const std::size_t step = along_u ? s.count_v : 1;
    const std::size_t first = !at_end ? 0 : along_u ? s.count_v - 1 : (s.count_u - 1) * s.count_v;
    for (std::size_t i = 1; i < count; ++i) {
        const Vector3 apart = s.control_points[first + i * step] - s.control_points[first];
        if (apart.norm() > resolution_mm) return std::nullopt;
    }
    return s.control_points[first];
}

Vector2 periods_of(const BSplineSurface& s) {
    return {s.closed_u ? s.end_u() - s.start_u() : 0, s.closed_v ? s.end_v() - s.start_v() : 0};
}

Point2 followed(Point2 uv, const Point2& last, const Vector2& period) {
    for (const int i : {0, 1}) {
        if (period[i] > 0) uv[i] += period[i] * std::round((last[i] - uv[i]) / period[i]);
    }
    return uv;
}

std::vector<ParameterLoop> parameter_loops(const Model& model, const Face& face,
                                           const Fineness& fineness) {
    Tracker tracker(*std::get<SharedBSplineSurface>(face.surface),
                    std::max(model.uncertainty_mm, resolution_mm), fineness);
    std::vector<ParameterLoop> loops;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        loops.push_back(tracker.loop(model, model.loops[l]));
    }
    return loops;
}

Eigen::Vector2i turns_of(const ParameterLoop& loop, const Vector2& period) {
    Eigen::Vector2i turns = Eigen::Vector2i::Zero();
    if (loop.nodes.empty()) return turns;
    const Point2 first = loop.nodes.front().uv;
    const Point2 last = followed(first, loop.nodes.back().uv, period);
    for (const int i : {0, 1}) {
        if (period[i] > 0)
            turns[i] = static_cast<int>(std::lround((last[i] - first[i]) / period[i]));
    }
    return turns;
}

}  // namespace lyr
