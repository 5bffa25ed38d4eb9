// Every node is the foot of an edge's point, found near the foot before it; its step is the edge's, resolved along
// d/du and d/dv.

#include "kernel/brep/parameter_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/brep/quadrature.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

std::vector<double> edge_borders(const Edge& edge) {
    constexpr double widest_panel_rad = std::numbers::pi / 8;
    const double from = std::min(edge.t_start, edge.t_end), to = std::max(edge.t_start, edge.t_end);
    std::vector<double> knots;
    if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
        knots = spline->knots;
    } else if (!std::holds_alternative<Line>(edge.curve)) {
        for (double t = from + widest_panel_rad; t < to; t += widest_panel_rad) knots.push_back(t);
    }
    return panel_borders(knots, from, to);
}

// What a step in space is in the parameters.
Vector2 parameter_step(const Partials& at, const Vector3& step) {
    const double uu = at.du.squaredNorm(), uv = at.du.dot(at.dv), vv = at.dv.squaredNorm();
    const double u = at.du.dot(step), v = at.dv.dot(step);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return Vector2::Zero();
    return Vector2(vv * u - uv * v, uu * v - uv * u) / determinant;
}

class Tracker {
public:
    Tracker(const BSplineSurface& surface, double closeness_mm)
        : surface_(surface), period_(periods_of(surface)), closeness_mm_(closeness_mm) {}

    ParameterLoop loop(const Model& model, const Loop& loop) {
        ParameterLoop result;
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            const Coedge& use = model.coedges[c];
            result.corners.push_back({result.nodes.size(), model[model.start_of(use)].point});
            if (!append_known(use, result.nodes)) append(model[use.edge], use, result.nodes);
        }
        return result;
    }

private:
    void append(const Edge& edge, const Coedge& use, std::vector<ParameterNode>& nodes) {
        std::vector<double> borders = edge_borders(edge);
        if (use.reversed != (edge.t_end < edge.t_start)) {
            std::reverse(borders.begin(), borders.end());
        }
        Passage passage{use, {}};
        for (std::size_t panel = 0; panel + 1 < borders.size(); ++panel) {
            const double width = borders[panel + 1] - borders[panel];
            for (std::size_t g = 0; g < gauss_at.size(); ++g) {
                const double t = borders[panel] + gauss_at[g] * width;
                const Vector3 step = gauss_weight[g] * width * derivative(edge.curve, t);
                const Foot foot = foot_of(evaluate(edge.curve, t), nodes);
                append({foot.uv, parameter_step(foot.at, step)}, nodes);
                passage.nodes.push_back(nodes.back());
            }
        }
        passages_.push_back(std::move(passage));
    }

    void append(ParameterNode node, std::vector<ParameterNode>& nodes) const {
        if (!nodes.empty()) node.uv = followed(node.uv, nodes.back().uv, period_);
        nodes.push_back(node);
    }

    // The way back along a seam needs no search.
    bool append_known(const Coedge& use, std::vector<ParameterNode>& nodes) const {
        for (const Passage& passage : passages_) {
            if (passage.use.edge != use.edge || passage.use.reversed == use.reversed) continue;
            for (auto node = passage.nodes.rbegin(); node != passage.nodes.rend(); ++node) {
                append({node->uv, -node->step}, nodes);
            }
            return true;
        }
        return false;
    }

    struct Passage {
        Coedge use;
        std::vector<ParameterNode> nodes;
    };
    struct Foot {
        Point2 uv;
        Partials at;
    };

    // Searched for once; from there on, neighbours are near. Where one is not, it was another place's neighbour.
    Foot foot_of(const Point3& point, const std::vector<ParameterNode>& nodes) {
        const double allowed_mm = std::max(2 * distance_mm_, closeness_mm_);
        if (!nodes.empty()) {
            const Foot near = foot_at(point, invert_near(surface_, point, nodes.back().uv));
            if (distance_mm_ <= allowed_mm) return near;
        }
        return foot_at(point, invert(surface_, point));
    }
    Foot foot_at(const Point3& point, const Point2& uv) {
        const Foot foot{uv, partials(surface_, uv)};
        distance_mm_ = (foot.at.point - point).norm();
        return foot;
    }

    const BSplineSurface& surface_;
    Vector2 period_;
    double closeness_mm_, distance_mm_ = 0;
    std::vector<Passage> passages_;
};

}  // namespace

Vector2 periods_of(const BSplineSurface& s) {
    return {s.closed_u ? s.end_u() - s.start_u() : 0, s.closed_v ? s.end_v() - s.start_v() : 0};
}

Point2 followed(Point2 uv, const Point2& last, const Vector2& period) {
    for (const int i : {0, 1}) {
        if (period[i] > 0) uv[i] += period[i] * std::round((last[i] - uv[i]) / period[i]);
    }
    return uv;
}

std::vector<ParameterLoop> parameter_loops(const Model& model, const Face& face) {
    Tracker tracker(*std::get<SharedBSplineSurface>(face.surface),
                    std::max(model.uncertainty_mm, resolution_mm));
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
