// Line integrals along the loops of faces. With o the surface's own origin seen from c, the integral of (p - c) . n
// over a face is o . S + r A on spheres and cylinders, o . S on planes, o . S + r cos(a) A on cones (o on the axis, r
// the radius at its height, a the half angle), and o . S + m A + M K on tori, where S is the integral of n, which
// depends on the boundary alone, A the face's area and K the integral of cos v, v the angle around the tube.
//
// On surfaces that close upon themselves a boundary does not say which of two regions it bounds: A and K are known
// up to the whole surface's, and A lies between zero and the whole.

#include "kernel/brep/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

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

// A point of a loop with the step of the integral there; at the vertices, without a step.
struct Node {
    Point3 point;
    Vector3 step;
};

using LoopNodes = std::vector<Node>;

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

using FaceNodes = std::vector<LoopNodes>;

FaceNodes nodes_of(const Model& model, const Face& face, Aim aim) {
    FaceNodes nodes;
    for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
        nodes.push_back(nodes_of(model, model.loops[l], aim));
    }
    return nodes;
}

// The integral of the outward normal: half of p x dp around the loops.
Vector3 vector_area(const FaceNodes& face, const Point3& c) {
    Vector3 sum = Vector3::Zero();
    for (const LoopNodes& loop : face) {
        for (const Node& node : loop) sum += (node.point - c).cross(node.step);
    }
    return sum / 2;
}

// Angle about the axis at a node, its step, and the coordinates that go with it.
struct AroundAxis {
    double x, y, z, step_x, step_y, step_z;

    AroundAxis(const Frame& frame, const Node& node) {
        const Point3 p = frame.to_local(node.point);
        x = p.x();
        y = p.y();
        z = p.z();
        step_x = node.step.dot(frame.x);
        step_y = node.step.dot(frame.y);
        step_z = node.step.dot(frame.z);
    }
    double radius() const { return std::hypot(x, y); }
    double angle_step() const {
        const double square = x * x + y * y;
        return square > 0 ? (x * step_y - y * step_x) / square : 0;
    }
};

double handedness(const Frame& frame) {
    return frame.x.cross(frame.y).dot(frame.z) < 0 ? -1 : 1;
}

double cylinder_area(const Cylinder& cylinder, const FaceNodes& face, double sense) {
    double sum = 0;
    for (const LoopNodes& loop : face) {
        for (const Node& node : loop) {
            const AroundAxis at(cylinder.frame, node);
            sum += at.z * at.angle_step();
        }
    }
    return -sense * handedness(cylinder.frame) * cylinder.radius_mm * sum;
}

double radius_at(const Cone& cone, double z) {
    return cone.radius_mm + z * std::tan(cone.half_angle_rad);
}

// A point of the axis at the height of the loops: an apex that is far away costs digits.
// Of the loops' vertices the widest.
Point3 level_with(const Cone& cone, const FaceNodes& face) {
    double widest = 0, level = 0;
    for (const LoopNodes& loop : face) {
        if (loop.empty()) continue;
        const double z = cone.frame.to_local(loop.front().point).z();
        if (std::abs(radius_at(cone, z)) <= widest) continue;
        widest = std::abs(radius_at(cone, z));
        level = z;
    }
    return cone.frame.origin + level * cone.frame.z;
}

// From the circle at a level to the loops, (r^2 - r0^2) / (2 sin) for each radian around the axis, in a form that does not
// cancel; and from the apex to the circle if the loops go around it.
double cone_area(const Cone& cone, const Point3& level, const FaceNodes& face, double sense) {
    const double z0 = cone.frame.to_local(level).z(), r0 = radius_at(cone, z0);
    constexpr double apex_closeness = 1e-6;  // a share of the radius at the level
    double sum = 0, turns = 0;
    bool through_apex = false;
    for (const LoopNodes& loop : face) {
        for (const Node& node : loop) {
            const AroundAxis at(cone.frame, node);
            sum += (at.z - z0) * (radius_at(cone, at.z) + r0) * at.angle_step();
            turns += at.angle_step() / (2 * pi);
            through_apex = through_apex || at.radius() <= apex_closeness * std::abs(r0);
        }
    }
    // What a loop turns on the spot in the apex is not among its steps, and leaves no whole number.
    if (!through_apex) turns = std::round(turns);
    const double to_apex = pi * r0 * r0 / std::sin(cone.half_angle_rad) * turns;
    return -sense * handedness(cone.frame) * (sum / (2 * std::cos(cone.half_angle_rad)) + to_apex);
}

// How many times `whole` has to be added to bring `value` into (0, whole]. A boundary that cancels bounds the whole.
double turns_to_add(double value, double whole) {
    constexpr double closeness = 1e-8;  // a smaller share of the whole is no face but round-off
    return -std::floor(value / whole - closeness);
}

// An axis that stays away from the loops: where they come near a pole, the angle about it changes abruptly.
Frame clear_axis(const Sphere& sphere, const FaceNodes& face) {
    const std::array<Vector3, 7> candidates{Vector3(1, 0, 0), Vector3(0, 1, 0),  Vector3(0, 0, 1),
                                            Vector3(1, 1, 1), Vector3(1, 1, -1), Vector3(1, -1, 1),
                                            Vector3(-1, 1, 1)};
    Frame best;
    double least_sine = -1;
    for (const Vector3& candidate : candidates) {
        const Vector3 axis = candidate.normalized();
        double sine = 1;
        for (const LoopNodes& loop : face) {
            for (const Node& node : loop) {
                const Vector3 offset = node.point - sphere.frame.origin;
                sine = std::min(sine, offset.cross(axis).norm() / sphere.radius_mm);
            }
        }
        if (sine <= least_sine) continue;
        least_sine = sine;
        best = {sphere.frame.origin, axis.unitOrthogonal(), axis.cross(axis.unitOrthogonal()),
                axis};
    }
    return best;
}

double sphere_area(const Sphere& sphere, const FaceNodes& face, double sense) {
    const Frame frame = clear_axis(sphere, face);
    double turns = 0, sum = 0;
    for (const LoopNodes& loop : face) {
        for (const Node& node : loop) {
            const AroundAxis at(frame, node);
            turns += at.angle_step();
            sum += at.angle_step() * at.z / std::hypot(at.radius(), at.z);
        }
    }
    const double solid_angle = sense * (2 * pi * std::round(turns / (2 * pi)) - sum);
    const double whole = 4 * pi;
    const double square = sphere.radius_mm * sphere.radius_mm;
    return square * (solid_angle + whole * turns_to_add(solid_angle, whole));
}

struct TorusIntegrals {
    double area, cosine, whole = 0;
};

// Angles along one loop, followed so that they do not jump.
class Follower {
public:
    double next(double angle) {
        if (!first_) angle += 2 * pi * std::round((last_ - angle) / (2 * pi));
        first_ = false;
        return last_ = angle;
    }

private:
    bool first_ = true;
    double last_ = 0;
};

TorusIntegrals torus_integrals(const Torus& torus, const FaceNodes& face, double sense) {
    const double major = torus.major_mm, minor = torus.minor_mm;
    TorusIntegrals over_v{0, 0}, over_u{0, 0};
    double turns_v = 0;
    for (const LoopNodes& loop : face) {
        Follower follow_u, follow_v;
        double loop_turns_v = 0;
        for (const Node& node : loop) {
            const AroundAxis at(torus.frame, node);
            const double out = at.radius() - major;
            const double u = follow_u.next(direction_angle(at.y, at.x));
            const double v = follow_v.next(direction_angle(at.z, out));
            const double step_u = at.angle_step();
            const double step_out = (at.x * at.step_x + at.y * at.step_y) / at.radius();
            const double step_v = (out * at.step_z - at.z * step_out) / (out * out + at.z * at.z);
            const double s = std::sin(v), c = std::cos(v);
            over_v.area -= minor * (major * v + minor * s) * step_u;
            over_v.cosine -= minor * (major * s + minor * (v + s * c) / 2) * step_u;
            over_u.area += u * minor * (major + minor * c) * step_v;
            over_u.cosine += u * minor * (major + minor * c) * c * step_v;
            loop_turns_v += step_v;
        }
        turns_v += std::abs(std::round(loop_turns_v / (2 * pi)));
    }
    // Loops that go around the tube have to be closed up across u, others across v.
    const TorusIntegrals& open = turns_v > 0 ? over_u : over_v;
    const double handed = handedness(torus.frame);
    const double area = sense * handed * open.area, cosine = sense * handed * open.cosine;
    const double whole_area = 4 * pi * pi * major * minor,
                 whole_cosine = 2 * pi * pi * minor * minor;
    const double turns = turns_to_add(area, whole_area);
    return {area + turns * whole_area, cosine + turns * whole_cosine, whole_area};
}

// Integrals along a meridian of the lemon from its waist, where v is pi.
TorusIntegrals along_meridian(const Torus& torus, double v) {
    const double major = torus.major_mm, minor = torus.minor_mm, s = std::sin(v), c = std::cos(v);
    return {-minor * (major * (v - pi) + minor * s),
            -minor * (major * s + minor * (v - pi + s * c) / 2)};
}

TorusIntegrals lemon_integrals(const Torus& torus, const FaceNodes& face, double sense) {
    const TorusIntegrals pole = along_meridian(torus, std::acos(-torus.major_mm / torus.minor_mm));
    TorusIntegrals sum{0, 0};
    for (const LoopNodes& loop : face) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const AroundAxis at(torus.frame, loop[i]);
            double step_u = at.angle_step();
            if (loop[i].step.isZero()) {
                // A meridian that ends in a pole goes on along another: a turn on the spot.
                constexpr double pole_closeness = 1e-6;
                if (at.radius() > pole_closeness * torus.minor_mm) continue;
                const AroundAxis before(torus.frame, loop[(i + loop.size() - 1) % loop.size()]);
                const AroundAxis after(torus.frame, loop[(i + 1) % loop.size()]);
                step_u = std::atan2(before.x * after.y - before.y * after.x,
                                    before.x * after.x + before.y * after.y);
            }
            const double v = std::atan2(-at.z, at.radius() + torus.major_mm) + pi;
            const TorusIntegrals here = along_meridian(torus, v);
            sum.area += (here.area - pole.area) * step_u;
            sum.cosine += (here.cosine - pole.cosine) * step_u;
        }
    }
    const TorusIntegrals whole{-4 * pi * pole.area, -4 * pi * pole.cosine};
    const double area = sense * handedness(torus.frame) * sum.area;
    const double turns = turns_to_add(area, whole.area);
    return {area + turns * whole.area,
            sense * handedness(torus.frame) * sum.cosine + turns * whole.cosine, whole.area};
}

TorusIntegrals tube_integrals(const Torus& torus, const FaceNodes& face, double sense) {
    return torus.inner_sheet ? lemon_integrals(torus, face, sense)
                             : torus_integrals(torus, face, sense);
}

// A face's area, and three times its part of the volume. `whole` is the area of a surface that closes upon itself.
struct FaceIntegrals {
    double area, flux, whole = 0;
};

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
    const FaceNodes nodes = nodes_of(model, face, aim);
    const double sense = face.same_sense ? 1 : -1;
    const Vector3 outward = vector_area(nodes, c);
    struct Visitor {
        const FaceNodes& nodes;
        double sense;
        Vector3 outward;
        Point3 c;
        FaceIntegrals operator()(const Plane&) const { return {0, 0}; }  // see above
        FaceIntegrals operator()(const Cylinder& s) const {
            const double area = cylinder_area(s, nodes, sense);
            return {area, (s.frame.origin - c).dot(outward) + sense * s.radius_mm * std::abs(area)};
        }
        FaceIntegrals operator()(const Cone& s) const {
            const Point3 level = level_with(s, nodes);
            const double area = cone_area(s, level, nodes, sense);
            const double offset =
                radius_at(s, s.frame.to_local(level).z()) * std::cos(s.half_angle_rad);
            return {area, (level - c).dot(outward) + sense * offset * std::abs(area)};
        }
        FaceIntegrals operator()(const Sphere& s) const {
            const double area = sphere_area(s, nodes, sense);
            return {area, (s.frame.origin - c).dot(outward) + sense * s.radius_mm * area,
                    4 * pi * s.radius_mm * s.radius_mm};
        }
        FaceIntegrals operator()(const Torus& s) const {
            const TorusIntegrals integrals = tube_integrals(s, nodes, sense);
            return {integrals.area,
                    (s.frame.origin - c).dot(outward) +
                        sense * (s.minor_mm * integrals.area + s.major_mm * integrals.cosine),
                    integrals.whole};
        }
        FaceIntegrals operator()(const SharedBSplineSurface&) const { return {0, 0}; }  // see above
    };
    return std::visit(Visitor{nodes, sense, outward, c}, face.surface);
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
