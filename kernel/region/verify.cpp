#include "kernel/region/verify.h"

#include <algorithm>
#include <cmath>

#include "kernel/region/winding_count.h"

namespace lyr::region {
namespace {

// Points to count at lie this many snaps off the middle of their edge. No other edge comes near the middle, and no curve
// of the input near the points: an edge bends off its curve by a snap, or by two where both its ends do.
constexpr double probe_snaps = 4;
constexpr double clear_snaps = 6;
constexpr double near_snaps = 2;

// Of edges, which are no more than half a circle.
std::vector<Box2> boxes_of(const Arrangement& arrangement, const Sweep& sweep) {
    std::vector<Box2> boxes;
    boxes.reserve(sweep.edges.size());
    for (const SweptEdge& edge : sweep.edges) {
        const Point2 &low = arrangement.vertices[edge.low], &high = arrangement.vertices[edge.high];
        const double sagitta = std::abs(edge.sagitta_mm);
        const Vector2 margin(sagitta, sagitta);
        boxes.push_back({low.cwiseMin(high) - margin, low.cwiseMax(high) + margin});
    }
    return boxes;
}

double chord_mm(const Arrangement& arrangement, const Edge& edge) {
    return (arrangement.vertices[edge.high] - arrangement.vertices[edge.low]).norm();
}

// By input contour; those of which nothing is left have none.
std::vector<std::uint32_t> longest_edges(const Arrangement& arrangement, const Sweep& sweep) {
    std::vector<std::uint32_t> longest(arrangement.steps.size(), none);
    for (std::uint32_t e = 0; e < sweep.edges.size(); ++e) {
        std::uint32_t& best = longest[arrangement.sources[sweep.edges[e].source].contour];
        if (best == none ||
            chord_mm(arrangement, sweep.edges[e]) > chord_mm(arrangement, sweep.edges[best])) {
            best = e;
        }
    }
    return longest;
}

}  // namespace

bool windings_agree(std::span<const Input> inputs, const Arrangement& arrangement,
                    const Sweep& sweep, double snap_mm) {
    const WindingCount count(inputs, arrangement.sources);
    const BoxTree tree(boxes_of(arrangement, sweep), BoxOrder::any);
    const auto shape = [&](std::uint32_t e) {
        return shape_of(sweep.edges[e], arrangement.vertices);
    };
    const double clear_mm = clear_snaps * snap_mm, near_mm = near_snaps * snap_mm;
    const auto is_alone = [&](std::uint32_t e, const Point2& middle) {
        const Vector2 margin(clear_mm, clear_mm);
        return !tree.any({middle - margin, middle + margin}, [&](std::uint32_t other) {
            return other != e && passes(shape(other), middle, clear_mm);
        });
    };
    const std::vector<std::uint32_t> longest = longest_edges(arrangement, sweep);
    return std::all_of(longest.begin(), longest.end(), [&](std::uint32_t e) {
        if (e == none) return true;
        const Curve curve = shape(e);
        if (!is_alone(e, curve.middle)) return true;
        const Vector2 across(-curve.tangent.y(), curve.tangent.x());
        const Point2 left = curve.middle + probe_snaps * snap_mm * across;
        const Point2 right = curve.middle - probe_snaps * snap_mm * across;
        // Where a curve passes, its edges may be on the other side of the point, or gone with those that they cancel.
        if (count.is_near(left, near_mm) || count.is_near(right, near_mm)) return true;
        return count.at(left) == sweep.edges[e].left && count.at(right) == sweep.edges[e].right;
    });
}

bool is_closed(const Sweep& sweep) {
    return std::all_of(sweep.edges.begin(), sweep.edges.end(),
                       [](const SweptEdge& edge) { return !edge.kept || edge.next != none; });
}

double area_mm2(const Arrangement& arrangement, const Sweep& sweep, const Counts& counts) {
    double area = 0;
    const std::vector<Point2>& points = arrangement.vertices;
    for (const SweptEdge& edge : sweep.edges) {
        const int rises = counts(edge.left) - counts(edge.right);
        if (rises == 0) continue;
        const Vector2 low = points[edge.low] - points.front();
        const Vector2 high = points[edge.high] - points.front();
        const Segment shape{points[edge.high], edge.sagitta_mm};
        area += rises * (cross(low, high) / 2 + enclosed_area_mm2(points[edge.low], shape));
    }
    return area;
}

bool is_finite(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return circle->centre.allFinite() && std::isfinite(circle->radius_mm);
    }
    const Path& path = std::get<Path>(contour);
    return path.start.allFinite() &&
           std::all_of(path.segments.begin(), path.segments.end(), [](const Segment& segment) {
               return segment.end.allFinite() && std::isfinite(segment.sagitta_mm);
           });
}

}  // namespace lyr::region
