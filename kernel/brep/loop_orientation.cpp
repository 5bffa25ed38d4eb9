// Loops are drawn in the surface's parameters, followed around where it is closed. There a loop has an area, and turns.

#include "kernel/brep/loop_orientation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

#include "kernel/brep/free_edges.h"
#include "kernel/brep/parameter_loops.h"

namespace lyr {
namespace {

std::vector<Point3> points_along(const Model& model, const Loop& loop) {
    std::vector<Point3> points;
    for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
        const Coedge& use = model.coedges[c];
        const Edge& edge = model[use.edge];
        const auto* spline = std::get_if<BSplineCurve>(&edge.curve);
        // Eight a turn leave no doubt about the short way from one to the next.
        const int count = spline ? 4 * static_cast<int>(spline->control_points.size()) : 8;
        for (int i = 0; i < count; ++i) {
            const double share = (i + 0.5) / count;
            points.push_back(point_on(edge, use.reversed ? 1 - share : share));
        }
    }
    return points;
}

// A loop in parameters: u is the direction that it may wind in.
struct Drawing {
    double area =
        0;  // of what it encloses, positive counter-clockwise; of a loop that does not wind
    int turns = 0;
    double mean_v = 0;  // over u, of a loop that winds
};

Drawing drawing_of(const std::vector<Point2>& uv, double period_u) {
    Drawing drawing;
    if (uv.empty()) return drawing;
    const auto step = [&](const Point2& from, const Point2& to) {
        Vector2 by = to - from;
        if (period_u > 0) by.x() = std::remainder(by.x(), period_u);
        return by;
    };
    Point2 at = Point2::Zero();
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const Vector2 by = step(uv[i], uv[(i + 1) % uv.size()]);
        drawing.area += (at.x() * by.y() - at.y() * by.x()) / 2;
        drawing.mean_v += (uv[i].y() + by.y() / 2) * by.x();
        at += by;
    }
    if (period_u > 0) drawing.turns = static_cast<int>(std::lround(at.x() / period_u));
    if (drawing.turns != 0) drawing.mean_v /= at.x();
    return drawing;
}

// Empty for surfaces on which loops are not compared by drawing.
std::vector<Drawing> drawings_of(const Model& model, const Face& face) {
    std::vector<Drawing> drawings;
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&face.surface)) {
        const Vector2 period = periods_of(**spline);
        if (period.x() > 0 && period.y() > 0) return {};
        const bool swapped = period.y() > 0;
        for (const ParameterLoop& loop : parameter_loops(model, face, for_figures)) {
            std::vector<Point2> uv;
            for (const ParameterNode& node : loop.nodes) {
                uv.push_back(swapped ? Point2(node.uv.y(), -node.uv.x()) : node.uv);
            }
            drawings.push_back(drawing_of(uv, std::max(period.x(), period.y())));
        }
        return drawings;
    }
    if (std::holds_alternative<Sphere>(face.surface) || std::holds_alternative<Torus>(face.surface))
        return {};
    const double period = std::holds_alternative<Plane>(face.surface) ? 0 : 2 * std::numbers::pi;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        std::vector<Point2> uv;
        for (const Point3& point : points_along(model, model.loops[l])) {
            uv.push_back(invert(face.surface, point));
        }
        drawings.push_back(drawing_of(uv, period));
    }
    return drawings;
}

// Whether winding loops run counter-clockwise about the face (+1) or clockwise (-1); the second of two that cannot both
// is `wrong`.
std::optional<int> side_by_winding(const std::vector<Drawing>& drawings, bool apex_is_below,
                                   std::vector<bool>& wrong) {
    std::vector<std::size_t> winding;
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        if (drawings[i].turns != 0) winding.push_back(i);
    }
    if (winding.size() == 1 && apex_is_below) return drawings[winding[0]].turns < 0 ? 1 : -1;
    if (winding.size() != 2) return std::nullopt;
    const Drawing &first = drawings[winding[0]], &second = drawings[winding[1]];
    if (first.turns == second.turns) wrong[winding[1]] = true;
    return (first.turns > 0) == (first.mean_v < second.mean_v) ? 1 : -1;
}

std::vector<bool> wrong_in_drawing(const std::vector<Drawing>& drawings, bool apex_is_below) {
    std::vector<bool> wrong(drawings.size(), false);
    const bool winds = std::any_of(drawings.begin(), drawings.end(),
                                   [](const Drawing& drawing) { return drawing.turns != 0; });
    std::size_t outer = drawings.size();
    std::optional<int> side;
    if (winds) {
        side = side_by_winding(drawings, apex_is_below, wrong);
    } else {
        const auto largest =
            std::max_element(drawings.begin(), drawings.end(),
                             [](auto& a, auto& b) { return std::abs(a.area) < std::abs(b.area); });
        outer = static_cast<std::size_t>(largest - drawings.begin());
        side = largest->area > 0 ? 1 : -1;
    }
    if (!side) return wrong;
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        if (i != outer && drawings[i].turns == 0) wrong[i] = drawings[i].area * *side > 0;
    }
    return wrong;
}

// Whether a point of the unit sphere is to the left of a loop on it, seen from outside. Seen in projection from that
// point, the point itself is at infinity, on the left of what runs clockwise; but projecting from it mirrors the globe.
bool is_left_of(const Vector3& point, const std::vector<Vector3>& loop) {
    const Vector3 x = point.unitOrthogonal(), y = point.cross(x);
    const auto project = [&](const Vector3& ray) {
        return Point2(Point2(x.dot(ray), y.dot(ray)) / (1 - point.dot(ray)));
    };
    double doubled_area = 0;
    Point2 before = project(loop.back());
    for (const Vector3& ray : loop) {
        const Point2 here = project(ray);
        doubled_area += before.x() * here.y() - before.y() * here.x();
        before = here;
    }
    return doubled_area >= 0;
}

std::vector<bool> wrong_on_sphere(const Model& model, const Face& face, const Sphere& sphere) {
    std::vector<std::vector<Vector3>> loops;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        loops.emplace_back();
        for (const Point3& point : points_along(model, model.loops[l])) {
            loops.back().push_back((point - sphere.frame.origin).normalized());
        }
    }
    std::vector<bool> wrong(loops.size(), false);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const auto& other = loops[(i + 1) % loops.size()];
        if (loops[i].empty() || other.empty()) continue;
        wrong[i] = is_left_of(other.front(), loops[i]) != face.same_sense;
    }
    return wrong;
}

}  // namespace

void reverse_loop(Model& model, const Loop& loop) {
    const auto first = model.coedges.begin() + loop.first_coedge;
    const auto last = first + loop.coedge_count;
    for (auto use = first; use != last; ++use) use->reversed = !use->reversed;
    std::reverse(first, last);
}

void reverse_face(Model& model, FaceId id) {
    Face& face = model.faces[id.value];
    face.same_sense = !face.same_sense;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        reverse_loop(model, model.loops[l]);
    }
}

std::size_t make_loops_agree(Model& model, FaceId id) {
    const Face& face = model[id];
    if (face.loop_count < 2) return 0;
    std::vector<bool> wrong;
    if (const auto* sphere = std::get_if<Sphere>(&face.surface)) {
        wrong = wrong_on_sphere(model, face, *sphere);
    } else {
        const std::vector<Drawing> drawings = drawings_of(model, face);
        if (drawings.empty()) return 0;
        // A cone's radius grows with v.
        wrong = wrong_in_drawing(drawings, std::holds_alternative<Cone>(face.surface));
    }
    std::size_t turned = 0;
    for (std::uint32_t l = 0; l < face.loop_count; ++l) {
        if (!wrong[l]) continue;
        reverse_loop(model, model.loops[face.first_loop + l]);
        ++turned;
    }
    return turned;
}

}  // namespace lyr
