// The parameters of an edge follow from where its vertices lie on the curve and from the sense. Only closed
// curves leave a choice of turns, and the sense decides it: along the parameter, and once around at most.

#include "kernel/brep/edge_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

struct Range {
    double start, end;
};

// Along the parameter of a curve that repeats: end in (start, start + turn].
Range around(double start, double end, double turn, bool same_vertex) {
    if (same_vertex) return {start, start + turn};
    double end_turned = end - turn * std::floor((end - start) / turn);
    if (end_turned <= start) end_turned += turn;
    return {start, end_turned};
}

// A B-spline that comes back to its first point without being declared closed: a vertex there has two
// parameters, and the one that makes the edge run forward is meant.
Range over_domain(const BSplineCurve& curve, Range found, bool same_vertex, double closeness_mm) {
    const double first = curve.domain_start(), last = curve.domain_end();
    if (same_vertex) return {first, last};
    if (found.end > found.start) return found;
    const Point3 seam = evaluate(curve, first);
    const bool start_at_seam = (evaluate(curve, found.start) - seam).norm() <= closeness_mm;
    const bool end_at_seam = (evaluate(curve, found.end) - seam).norm() <= closeness_mm;
    if (start_at_seam) found.start = first;
    if (end_at_seam) found.end = last;
    return found;
}

Range along_parameter(const Curve& curve, const Point3& start, const Point3& end, bool same_vertex,
                      double closeness_mm) {
    const Range found{invert(curve, start), invert(curve, end)};
    const auto* spline = std::get_if<BSplineCurve>(&curve);
    if (spline && same_vertex) {
        const double last = spline->domain_end(), first = spline->domain_start();
        const bool at_seam = (evaluate(curve, first) - start).norm() <= closeness_mm ||
                             found.start <= first || found.start >= last;
        if (at_seam) return {first, last};
    }
    if (const double turn = period(curve); turn > 0) {
        return around(found.start, found.end, turn, same_vertex);
    }
    return spline ? over_domain(*spline, found, same_vertex, closeness_mm) : found;
}

void report_distance(const Curve& curve, double t, const Vertex& vertex, SourceId edge,
                     double allowed_mm, Diagnostics& diagnostics) {
    const double distance_mm = (evaluate(curve, t) - vertex.point).norm();
    if (distance_mm <= allowed_mm) return;
    char text[96];
    std::snprintf(text, sizeof text, "vertex #%llu is %.3g mm off the edge's curve",
                  static_cast<unsigned long long>(vertex.source), distance_mm);
    diagnostics.push_back({Severity::warning,
                           ExitStatus::geometry,
                           text,
                           {.entity = edge,
                            .layer = {},
                            .x_mm = vertex.point.x(),
                            .y_mm = vertex.point.y(),
                            .z_mm = vertex.point.z()}});
}

}  // namespace

Edge make_edge(const Curve& curve, VertexId start, VertexId end, bool same_sense, SourceId source,
               const Model& model, double uncertainty_mm, Diagnostics& diagnostics) {
    const double allowed_mm = std::max(uncertainty_mm, resolution_mm);
    const VertexId first = same_sense ? start : end, second = same_sense ? end : start;
    const Range range =
        along_parameter(curve, model[first].point, model[second].point, start == end, allowed_mm);
    Edge edge{curve, range.start, range.end, start, end, source};
    if (!same_sense) std::swap(edge.t_start, edge.t_end);
    report_distance(curve, edge.t_start, model[start], source, allowed_mm, diagnostics);
    if (start != end) {
        report_distance(curve, edge.t_end, model[end], source, allowed_mm, diagnostics);
    }
    return edge;
}

}  // namespace lyr
