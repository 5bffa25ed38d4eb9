#include "kernel/brep/free_edges.h"

#include <algorithm>
#include <cmath>

namespace lyr {

namespace {

template <class Visit>
void for_each_use(const Model& model, Visit visit) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const Face& face = model.faces[f];
        for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
            const Loop& loop = model.loops[l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                visit(FaceId{f}, model.coedges[loop.first_coedge + c]);
            }
        }
    }
}

}  // namespace

std::vector<FreeEdge> free_edges(const Model& model) {
    std::vector<std::uint32_t> uses(model.edges.size(), 0);
    for_each_use(model, [&](FaceId, const Coedge& use) { ++uses[use.edge.value]; });
    std::vector<FreeEdge> free;
    for_each_use(model, [&](FaceId face, const Coedge& use) {
        if (uses[use.edge.value] == 1) free.push_back({use.edge, face, use.reversed});
    });
    return free;
}

double nearest_parameter(const Edge& edge, const Point3& point) {
    const double low = std::min(edge.t_start, edge.t_end);
    const double high = std::max(edge.t_start, edge.t_end);
    double t = invert(edge.curve, point);
    if (const double turn = period(edge.curve); turn > 0) t += turn * std::ceil((low - t) / turn);
    if (t >= low && t <= high) return t;
    const double to_start = (evaluate(edge.curve, edge.t_start) - point).squaredNorm();
    const double to_end = (evaluate(edge.curve, edge.t_end) - point).squaredNorm();
    return to_start <= to_end ? edge.t_start : edge.t_end;
}

Point3 point_on(const Edge& edge, double share) {
    return evaluate(edge.curve, edge.t_start + share * (edge.t_end - edge.t_start));
}

double rough_length_mm(const Edge& edge) {
    const int chords = std::holds_alternative<Line>(edge.curve) ? 1 : 8;
    double length = 0;
    Point3 before = point_on(edge, 0);
    for (int i = 1; i <= chords; ++i) {
        const Point3 here = point_on(edge, static_cast<double>(i) / chords);
        length += (here - before).norm();
        before = here;
    }
    return length;
}

}  // namespace lyr
