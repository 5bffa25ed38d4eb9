// Line integrals along the loops of faces, by Gauss' rule on panels of their edges; what each kind of surface makes of
// them is in elementary_integrals.h and freeform_integrals.h.

#include "kernel/brep/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "kernel/brep/elementary_integrals.h"
#include "kernel/brep/freeform_integrals.h"
#include "kernel/brep/loop_orientation.h"
#include "kernel/geometry/angle.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

using std::numbers::pi;

// Gauss-Legendre on [0, 1].
struct GaussPoint {
    double at, weight;
};
// Exact for polynomials of degree nine, and of degree five.
constexpr std::array<GaussPoint, 5> five_points{{{0.04691007703066800, 0.11846344252809454},
                                                 {0.23076534494715845, 0.23931433524968324},
                                                 {0.5, 0.28444444444444444},
                                                 {0.76923465505284155, 0.23931433524968324},
                                                 {0.95308992296933200, 0.11846344252809454}}};
constexpr std::array<GaussPoint, 3> three_points{
    {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}}};

// What integrals are taken for: to be told, or to see which sign they have.
enum class Aim { figure, sign };

std::span<const GaussPoint> points_for(Aim aim) {
    if (aim == Aim::sign) return three_points;
    return five_points;
}

// How many panels of such points an edge needs.
int panels(const Edge& edge, Aim aim) {
    if (const auto* spline = std::get_if<BSplineCurve>(&edge.curve)) {
        const auto points = static_cast<int>(spline->control_points.size());
        return aim == Aim::sign ? (points + 1) / 2 : 2 * points;
    }
    const double widest_panel_rad = aim == Aim::sign ? pi / 2 : pi / 6;
    return 1 + static_cast<int>(std::abs(edge.t_end - edge.t_start) / widest_panel_rad);
}

// A node's point and, times `weight`, the curve's derivative. Along a circle the one is the other, turned.
Node node_at(const Curve& curve, double t, double weight) {
    if (const auto* circle = std::get_if<Circle>(&curve)) {
        const Point3 point = evaluate(curve, t);
        const Vector3 turned =
            circle->frame.x.cross(circle->frame.y).cross(point - circle->frame.origin);
        return {point, weight * turned};
    }
    const auto [point, tangent] = point_and_tangent(curve, t);
    return {point, weight * tangent};
}

enum class Vertices { visited, left_out };

// Calls visit(node) along the loop.
template <Vertices vertices = Vertices::visited, class Visit>
void for_each_node(const Model& model, const Loop& loop, Aim aim, Visit visit) {
    for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
        const Coedge& use = model.coedges[c];
        const Edge& edge = model[use.edge];
        const double from = use.reversed ? edge.t_end : edge.t_start;
        const double to = use.reversed ? edge.t_start : edge.t_end;
        if constexpr (vertices == Vertices::visited)
            visit(Node{evaluate(edge.curve, from), Vector3::Zero()});
        if (std::holds_alternative<Line>(edge.curve)) {
            // All integrands are linear along lines.
            visit(node_at(edge.curve, 0.5 * (from + to), to - from));
            continue;
        }
        const int count = panels(edge, aim);
        const double width = (to - from) / count;
        for (int panel = 0; panel < count; ++panel) {
            for (const GaussPoint& point : points_for(aim)) {
                const double t = from + (panel + point.at) * width;
                visit(node_at(edge.curve, t, point.weight * width));
            }
        }
    }
}

LoopNodes nodes_of(const Model& model, const Loop& loop, Aim aim) {
    LoopNodes nodes;
    nodes.reserve(2 * std::size_t{loop.coedge_count});
    for_each_node(model, loop, aim, [&](const Node& node) { nodes.push_back(node); });
    return nodes;
}

FaceNodes nodes_of(const Model& model, const Face& face, Aim aim) {
    FaceNodes nodes;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        nodes.push_back(nodes_of(model, model.loops[l], aim));
    }
    return nodes;
}

// Most faces are plane, and need no nodes kept.
FaceIntegrals plane_integrals(const Model& model, const Face& face, const Point3& c, Aim aim) {
    const Plane& plane = std::get<Plane>(face.surface);
    Vector3 doubled = Vector3::Zero();
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        for_each_node<Vertices::left_out>(model, model.loops[l], aim, [&](const Node& node) {
            doubled += (node.point - c).cross(node.step);
        });
    }
    const Vector3 outward = doubled / 2;
    return {(face.same_sense ? 1 : -1) * plane.frame.z.dot(outward),
            (plane.frame.origin - c).dot(outward)};
}

FaceIntegrals integrals_of(const Model& model, const Face& face, const Point3& c, Aim aim) {
    if (std::holds_alternative<SharedBSplineSurface>(face.surface)) {
        const FreeformIntegrals integrals =
            freeform_integrals(model, face, c, aim == Aim::sign ? for_signs : for_figures);
        return {integrals.area_mm2, integrals.flux_mm3};
    }
    if (std::holds_alternative<Plane>(face.surface)) return plane_integrals(model, face, c, aim);
    return elementary_integrals(face.surface, nodes_of(model, face, aim), face.same_sense ? 1 : -1,
                                c);
}

// A point near the shell, against cancellation.
Point3 near_point(const Model& model, const Shell& shell) {
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        const Face& face = model.faces[f];
        for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
            if (model.loops[l].coedge_count == 0) continue;
            return model[model[model.coedges[model.loops[l].first_coedge].edge].start].point;
        }
    }
    const Face& face = model.faces[shell.first_face];
    return std::visit(
        [](const auto& s) -> Point3 {
            if constexpr (std::is_same_v<std::decay_t<decltype(s)>, SharedBSplineSurface>) {
                return s->control_points.front();
            } else {
                return s.frame.origin;
            }
        },
        face.surface);
}

// Rough integrals are right to some ten-thousandths: of the square of the length around a face, or of the power 3/2 of a
// shell's area.
constexpr double certain_share = 1e-3;

// A lower bound for the length of the face's boundary.
double chord_length(const Model& model, const Face& face) {
    double length = 0;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        const Loop& loop = model.loops[l];
        for (std::uint32_t c = loop.first_coedge; c < loop.first_coedge + loop.coedge_count; ++c) {
            const Edge& edge = model[model.coedges[c].edge];
            const Point3 &start = model[edge.start].point, &end = model[edge.end].point;
            if (std::holds_alternative<Line>(edge.curve)) {
                length += (end - start).norm();
                continue;
            }
            const Point3 middle = evaluate(edge.curve, 0.5 * (edge.t_start + edge.t_end));
            length += (start - middle).norm() + (end - middle).norm();
        }
    }
    return length;
}

bool is_closed_spline(const Surface& surface) {
    const auto* spline = std::get_if<SharedBSplineSurface>(&surface);
    return spline && ((*spline)->closed_u || (*spline)->closed_v);
}

// Integrals whose signs are right: roughly where that is certain, else as exactly as can be. On a surface that closes upon
// itself all but nothing and all but the whole are as uncertain as all but nothing elsewhere.
FaceIntegrals integrals_for_signs(const Model& model, const Face& face, const Point3& c) {
    if (!is_closed_spline(face.surface)) {
        const FaceIntegrals rough = integrals_of(model, face, c, Aim::sign);
        const double length = chord_length(model, face);
        const double least = certain_share * (rough.whole > 0 ? rough.whole : length * length);
        const bool is_rest = rough.whole > 0 && rough.area > rough.whole - least;
        if (std::abs(rough.area) > least && !is_rest) return rough;
    }
    return integrals_of(model, face, c, Aim::figure);
}

// Takes the loops' word where same_sense contradicts them.
ShellOrientation turn_faces(Model& model, ShellId id, Aim aim) {
    // The sign of a sliver's area is that of its edges' round-off: resolution_mm over a length of ten metres.
    constexpr double certain_area_mm2 = resolution_mm * 1e4;
    const Shell& shell = model[id];
    const Point3 c = near_point(model, shell);
    ShellOrientation result;
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        Face& face = model.faces[f];
        const auto integrals_now = [&] {
            return aim == Aim::sign ? integrals_for_signs(model, face, c)
                                    : integrals_of(model, face, c, aim);
        };
        FaceIntegrals integrals = integrals_now();
        if (integrals.area < -certain_area_mm2) {
            face.same_sense = !face.same_sense;
            ++result.faces_turned;
            integrals = integrals_now();
        }
        result.volume_mm3 += integrals.flux / 3;
        result.area_mm2 += std::abs(integrals.area);
    }
    return result;
}

}  // namespace

double signed_volume_mm3(const Model& model, ShellId id) {
    const Shell& shell = model[id];
    const Point3 c = near_point(model, shell);
    double sum = 0;
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        sum += integrals_of(model, model.faces[f], c, Aim::figure).flux;
    }
    return sum / 3;
}

double signed_area_mm2(const Model& model, FaceId id) {
    return integrals_of(model, model[id], near_point(model, model[model[id].shell]), Aim::figure)
        .area;
}

ShellOrientation orient_closed_shell(Model& model, ShellId id, bool is_void) {
    std::vector<bool> stated;
    for (std::size_t f = 0; f < model[id].face_count; ++f)
        stated.push_back(model.faces[model[id].first_face + f].same_sense);
    ShellOrientation result = turn_faces(model, id, Aim::sign);
    if (std::abs(result.volume_mm3) < certain_share * std::pow(result.area_mm2, 1.5)) {
        for (std::size_t i = 0; i < stated.size(); ++i)
            model.faces[model[id].first_face + i].same_sense = stated[i];
        result = turn_faces(model, id, Aim::figure);
    }
    result.is_reversed = is_void ? result.volume_mm3 > 0 : result.volume_mm3 < 0;
    if (result.is_reversed) reverse_shell(model, id);
    return result;
}

void reverse_shell(Model& model, ShellId id) {
    const Shell& shell = model[id];
    for (std::uint32_t f = shell.first_face; f < shell.first_face + shell.face_count; ++f) {
        reverse_face(model, FaceId{f});
    }
}

}  // namespace lyr
