// Solids for the kernel's tests, built face by face; all are about the origin with their axis along z.

#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "kernel/brep/edge_builder.h"
#include "kernel/brep/model.h"

namespace lyr::testing {

using std::numbers::pi;

struct Use {
    EdgeId edge;
    bool reversed = false;
};

// Collects tables; finish() makes one solid of one shell of all faces so far.
class Builder {
public:
    VertexId vertex(double x, double y, double z) {
        model_.vertices.push_back({{x, y, z}, model_.vertices.size() + 1});
        return VertexId{model_.vertices.size() - 1};
    }
    EdgeId edge(const Curve& curve, VertexId start, VertexId end, bool same_sense = true) {
        Diagnostics found;
        model_.edges.push_back(
            make_edge(curve, start, end, same_sense, 1000 + model_.edges.size(), model_, 0, found));
        problems_.insert(problems_.end(), found.begin(), found.end());
        return EdgeId{model_.edges.size() - 1};
    }
    EdgeId line(VertexId start, VertexId end) {
        const Point3& a = model_[start].point;
        return edge(Line{a, (model_[end].point - a).normalized()}, start, end);
    }
    EdgeId circle(double z, double radius, VertexId at) {
        return edge(Circle{frame_at({0, 0, z}), radius}, at, at);
    }
    void face(const Surface& surface, bool same_sense,
              std::initializer_list<std::vector<Use>> loops) {
        model_.faces.push_back(
            {surface, same_sense, static_cast<std::uint32_t>(model_.loops.size()),
             static_cast<std::uint32_t>(loops.size()), ShellId{0}, 2000 + model_.faces.size()});
        for (const auto& uses : loops) {
            model_.loops.push_back({static_cast<std::uint32_t>(model_.coedges.size()),
                                    static_cast<std::uint32_t>(uses.size()), 0});
            for (const Use& use : uses) model_.coedges.push_back({use.edge, use.reversed});
        }
    }
    Model finish() {
        model_.shells.push_back(
            {0, static_cast<std::uint32_t>(model_.faces.size()), SolidId{0}, 0});
        model_.solids.push_back({"solid", 0, 1, 0});
        return std::move(model_);
    }
    const Diagnostics& problems() const { return problems_; }

    static Frame frame_at(const Point3& origin) {
        Frame frame;
        frame.origin = origin;
        return frame;
    }
    static Frame looking(const Point3& origin, const Vector3& z) {
        Frame frame;
        frame.origin = origin;
        frame.z = z;
        frame.x = z.unitOrthogonal();
        frame.y = z.cross(frame.x);
        return frame;
    }

private:
    Model model_;
    Diagnostics problems_;
};

inline Model box(double x, double y, double z) {
    Builder b;
    VertexId v[2][2][2];
    for (int i : {0, 1})
        for (int j : {0, 1})
            for (int k : {0, 1}) v[i][j][k] = b.vertex((i - 0.5) * x, (j - 0.5) * y, (k - 0.5) * z);
    EdgeId ex[2][2], ey[2][2], ez[2][2];
    for (int i : {0, 1})
        for (int j : {0, 1}) {
            ex[i][j] = b.line(v[0][i][j], v[1][i][j]);
            ey[i][j] = b.line(v[i][0][j], v[i][1][j]);
            ez[i][j] = b.line(v[i][j][0], v[i][j][1]);
        }
    for (int s : {0, 1}) {
        const double sign = s ? 1 : -1;
        const bool low = s == 0;
        // Each loop runs counter-clockwise seen against +axis; on the low side it is turned round.
        const auto face = [&](const Vector3& axis, double at, std::vector<Use> loop) {
            if (low) {
                std::reverse(loop.begin(), loop.end());
                for (Use& use : loop) use.reversed = !use.reversed;
            }
            b.face(Plane{Builder::looking(at * axis, axis)}, !low, {loop});
        };
        face(Vector3::UnitX(), sign * x / 2,
             {{ey[s][0]}, {ez[s][1]}, {ey[s][1], true}, {ez[s][0], true}});
        face(Vector3::UnitY(), sign * y / 2,
             {{ez[0][s]}, {ex[s][1]}, {ez[1][s], true}, {ex[s][0], true}});
        face(Vector3::UnitZ(), sign * z / 2,
             {{ex[0][s]}, {ey[1][s]}, {ex[1][s], true}, {ey[0][s], true}});
    }
    return b.finish();
}

// A box with a bore along z.
inline Model drilled_box(double x, double y, double z, double radius) {
    const Model whole = box(x, y, z);
    Model model = whole;
    model.loops.clear();
    model.coedges.clear();
    EdgeId rim[2];
    for (const int s : {0, 1}) {
        const double height = (s - 0.5) * z;
        const VertexId at{model.vertices.size()};
        model.vertices.push_back({{radius, 0, height}, 80 + at.value});
        rim[s] = EdgeId{model.edges.size()};
        model.edges.push_back({Circle{Builder::frame_at({0, 0, height}), radius}, 0, 2 * pi, at, at,
                               1000 + rim[s].value});
    }
    const auto add_loop = [&](const std::vector<Coedge>& coedges) {
        model.loops.push_back({static_cast<std::uint32_t>(model.coedges.size()),
                               static_cast<std::uint32_t>(coedges.size()), 0});
        model.coedges.insert(model.coedges.end(), coedges.begin(), coedges.end());
        return static_cast<std::uint32_t>(model.loops.size() - 1);
    };
    for (Face& face : model.faces) {
        const auto first = whole.coedges.begin() + whole.loops[face.first_loop].first_coedge;
        face.first_loop = add_loop({first, first + 4});
        const Plane& plane = std::get<Plane>(face.surface);
        if (std::abs(plane.frame.z.z()) < 0.5) continue;
        const int s = plane.frame.origin.z() > 0 ? 1 : 0;
        add_loop({{rim[s], s == 1}});
        face.loop_count = 2;
    }
    const std::uint32_t inside = add_loop({{rim[0], true}});
    add_loop({{rim[1], false}});
    model.faces.push_back(
        {Cylinder{Builder::frame_at({0, 0, 0}), radius}, false, inside, 2, ShellId{0}, 2999});
    ++model.shells[0].face_count;
    return model;
}

inline Surface side_surface(double r0, double r1, double h) {
    if (r0 == r1) return Cylinder{Builder::frame_at({0, 0, -h / 2}), r0};
    if (r0 < r1) return Cone{Builder::frame_at({0, 0, -h / 2}), r0, std::atan2(r1 - r0, h)};
    return Cone{Builder::looking({0, 0, h / 2}, -Vector3::UnitZ()), r1, std::atan2(r0 - r1, h)};
}

enum class Side { seam, halves, two_loops };

// A frustum with radii r0 at -h/2 and r1 at +h/2; a cylinder if they are equal.
inline Model frustum(double r0, double r1, double h, Side side) {
    Builder b;
    const double z0 = -h / 2, z1 = h / 2;
    const Surface surface = side_surface(r0, r1, h);
    const VertexId low = b.vertex(r0, 0, z0), high = b.vertex(r1, 0, z1);
    const Plane bottom{Builder::looking({0, 0, z0}, -Vector3::UnitZ())};
    const Plane top{Builder::frame_at({0, 0, z1})};
    if (side == Side::halves) {
        const VertexId low2 = b.vertex(-r0, 0, z0), high2 = b.vertex(-r1, 0, z1);
        const Circle c0{Builder::frame_at({0, 0, z0}), r0}, c1{Builder::frame_at({0, 0, z1}), r1};
        const EdgeId l0 = b.edge(c0, low, low2), l1 = b.edge(c0, low2, low);
        const EdgeId h0 = b.edge(c1, high, high2), h1 = b.edge(c1, high2, high);
        const EdgeId s0 = b.line(low, high), s1 = b.line(low2, high2);
        b.face(bottom, true, {{{l1, true}, {l0, true}}});
        b.face(top, true, {{{h0}, {h1}}});
        b.face(surface, true, {{{l0}, {s1}, {h0, true}, {s0, true}}});
        b.face(surface, true, {{{l1}, {s0}, {h1, true}, {s1, true}}});
        return b.finish();
    }
    const EdgeId c0 = b.circle(z0, r0, low), c1 = b.circle(z1, r1, high);
    b.face(bottom, true, {{{c0, true}}});
    b.face(top, true, {{{c1}}});
    if (side == Side::seam) {
        const EdgeId seam = b.line(low, high);
        b.face(surface, true, {{{c0}, {seam}, {c1, true}, {seam, true}}});
    } else {
        b.face(surface, true, {{{c0}}, {{c1, true}}});
    }
    return b.finish();
}

// The upper half of a cylinder lying along y: its side face begins and ends at level tangents if it is stood on
// an edge.
inline Model half_round(double radius, double length) {
    Builder b;
    VertexId v[2][2];
    EdgeId arc[2], floor[2], side[2];
    Frame frame;
    frame.z = -Vector3::UnitY();
    frame.y = Vector3::UnitZ();
    for (int e : {0, 1}) {
        const double y = (e - 0.5) * length;
        frame.origin = {0, y, 0};
        v[e][0] = b.vertex(radius, y, 0);
        v[e][1] = b.vertex(-radius, y, 0);
        arc[e] = b.edge(Circle{frame, radius}, v[e][0], v[e][1]);
        floor[e] = b.line(v[e][1], v[e][0]);
    }
    for (int s : {0, 1}) side[s] = b.line(v[0][s], v[1][s]);
    frame.origin = {0, -length / 2, 0};
    b.face(Cylinder{frame, radius}, true, {{{side[0]}, {arc[1]}, {side[1], true}, {arc[0], true}}});
    b.face(Plane{Builder::looking({0, 0, 0}, -Vector3::UnitZ())}, true,
           {{{side[1]}, {floor[1]}, {side[0], true}, {floor[0], true}}});
    b.face(Plane{Builder::looking({0, -length / 2, 0}, -Vector3::UnitY())}, true,
           {{{arc[0]}, {floor[0]}}});
    b.face(Plane{Builder::looking({0, length / 2, 0}, Vector3::UnitY())}, true,
           {{{floor[1], true}, {arc[1], true}}});
    return b.finish();
}

inline Model cone_with_apex(double radius, double h, bool seam) {
    Builder b;
    const double z0 = -h / 2;
    const VertexId base = b.vertex(radius, 0, z0), apex = b.vertex(0, 0, h / 2);
    const EdgeId circle = b.circle(z0, radius, base);
    const Cone cone{Builder::looking({0, 0, h / 2}, -Vector3::UnitZ()), 0, std::atan2(radius, h)};
    b.face(Plane{Builder::looking({0, 0, z0}, -Vector3::UnitZ())}, true, {{{circle, true}}});
    if (seam) {
        const EdgeId line = b.line(base, apex);
        b.face(cone, true, {{{circle}, {line}, {line, true}}});
    } else {
        b.face(cone, true, {{{circle}}, {}});
    }
    return b.finish();
}

inline Model sphere(double radius, bool seam) {
    Builder b;
    const Sphere surface{Builder::frame_at({0, 0, 0}), radius};
    if (!seam) {
        b.face(surface, true, {});
        return b.finish();
    }
    const VertexId south = b.vertex(0, 0, -radius), north = b.vertex(0, 0, radius);
    Frame meridian;
    meridian.y = Vector3::UnitZ();
    meridian.z = -Vector3::UnitY();
    const EdgeId line = b.edge(Circle{meridian, radius}, south, north);
    b.face(surface, true, {{{line}, {line, true}}});
    return b.finish();
}

// Half a ball's complement in height: the ball over z = -cut.
inline Model cut_ball(double radius, double cut) {
    Builder b;
    const double r = std::sqrt(radius * radius - cut * cut);
    const VertexId v = b.vertex(r, 0, -cut);
    const EdgeId rim = b.circle(-cut, r, v);
    b.face(Sphere{Builder::frame_at({0, 0, 0}), radius}, true, {{{rim}}});
    b.face(Plane{Builder::looking({0, 0, -cut}, -Vector3::UnitZ())}, true, {{{rim, true}}});
    return b.finish();
}

// A ball of two faces that meet in its equator.
inline Model halved_ball(double radius) {
    Builder b;
    const Sphere surface{Builder::frame_at({0, 0, 0}), radius};
    const VertexId v = b.vertex(radius, 0, 0);
    const EdgeId equator = b.circle(0, radius, v);
    b.face(surface, true, {{{equator}}});
    b.face(surface, true, {{{equator, true}}});
    return b.finish();
}

// A torus of two faces that meet in the two circles at half height.
inline Model halved_torus(double major, double minor) {
    Builder b;
    const Torus surface{Builder::frame_at({0, 0, 0}), major, minor};
    const VertexId v = b.vertex(major + minor, 0, 0), w = b.vertex(major - minor, 0, 0);
    const EdgeId outer = b.circle(0, major + minor, v), inner = b.circle(0, major - minor, w);
    b.face(surface, true, {{{outer}}, {{inner, true}}});
    b.face(surface, true, {{{outer, true}}, {{inner}}});
    return b.finish();
}

inline Model torus(double major, double minor, bool seam) {
    Builder b;
    const Torus surface{Builder::frame_at({0, 0, 0}), major, minor};
    if (!seam) {
        b.face(surface, true, {});
        return b.finish();
    }
    const VertexId v = b.vertex(major + minor, 0, 0);
    const EdgeId around = b.circle(0, major + minor, v);
    Frame tube;
    tube.origin = {major, 0, 0};
    tube.y = Vector3::UnitZ();
    tube.z = -Vector3::UnitY();
    const EdgeId across = b.edge(Circle{tube, minor}, v, v);
    b.face(surface, true, {{{around}, {across}, {around, true}, {across, true}}});
    return b.finish();
}

// A dome over the circle of the given radius: a sheet of a spindle torus (minor > major), cut at its rim's plane. The
// outer sheet is dented at the axis, the inner one pointed.
inline Model spindle_dome(double major, double minor, double radius, bool inner_sheet) {
    Builder b;
    const double from_tube = inner_sheet ? radius + major : radius - major;
    const double z = std::sqrt(minor * minor - from_tube * from_tube);
    const VertexId v = b.vertex(radius, 0, z);
    const EdgeId rim = b.circle(z, radius, v);
    b.face(Torus{Builder::frame_at({0, 0, 0}), major, minor, inner_sheet}, true, {{{rim}}});
    b.face(Plane{Builder::looking({0, 0, z}, -Vector3::UnitZ())}, true, {{{rim, true}}});
    return b.finish();
}

// A hexagonal prism (corners at `corner`, from z = 0) whose top is turned to a cone of 45 degrees: its axis is the
// prism's, its rim the circle of radius `flat` at height `top`. The cone meets the sides in hyperbolas.
inline Model hexagon_under_cone(double corner, double flat, double top) {
    Builder b;
    const double low = top - (corner - flat);  // of the corners
    const VertexId rim_vertex = b.vertex(flat, 0, top);
    const EdgeId rim = b.circle(top, flat, rim_vertex);
    std::vector<VertexId> foot, head;
    for (int i = 0; i < 6; ++i) {
        const double a = i * pi / 3;
        foot.push_back(b.vertex(corner * std::cos(a), corner * std::sin(a), 0));
        head.push_back(b.vertex(corner * std::cos(a), corner * std::sin(a), low));
    }
    std::vector<Use> floor, ceiling;
    std::vector<EdgeId> bottoms, arcs, sides;
    const double apothem = corner * std::cos(pi / 6);
    for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t next = (i + 1) % 6;
        const double a = (static_cast<double>(i) + 0.5) * pi / 3;
        const Vector3 out(std::cos(a), std::sin(a), 0), along(-std::sin(a), std::cos(a), 0);
        // z = top + flat - sqrt(apothem^2 + s^2): a hyperbola opening downwards.
        Frame frame;
        frame.origin = apothem * out + (top + flat) * Vector3::UnitZ();
        frame.x = -Vector3::UnitZ();
        frame.y = along;
        frame.z = frame.x.cross(frame.y);
        bottoms.push_back(b.line(foot[i], foot[next]));
        sides.push_back(b.line(foot[i], head[i]));
        arcs.push_back(b.edge(Hyperbola{frame, apothem, apothem}, head[i], head[next]));
    }
    for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t next = (i + 1) % 6;
        const double a = (static_cast<double>(i) + 0.5) * pi / 3;
        const Vector3 out(std::cos(a), std::sin(a), 0);
        b.face(Plane{Builder::looking(apothem * out, out)}, true,
               {{{bottoms[i]}, {sides[next]}, {arcs[i], true}, {sides[i], true}}});
        floor.insert(floor.begin(), Use{bottoms[i], true});
        ceiling.push_back({arcs[i]});
    }
    b.face(Plane{Builder::looking({0, 0, 0}, -Vector3::UnitZ())}, true, {floor});
    b.face(Cone{Builder::looking({0, 0, top}, -Vector3::UnitZ()), flat, pi / 4}, true,
           {ceiling, {{rim, true}}});
    b.face(Plane{Builder::frame_at({0, 0, top})}, true, {{{rim}}});
    return b.finish();
}

// The same solid with its inside out: material around it, as a void.
inline Model inside_out(Model model) {
    for (Face& face : model.faces) face.same_sense = !face.same_sense;
    for (Coedge& coedge : model.coedges) coedge.reversed = !coedge.reversed;
    for (const Loop& loop : model.loops) {
        std::reverse(model.coedges.begin() + loop.first_coedge,
                     model.coedges.begin() + loop.first_coedge + loop.coedge_count);
    }
    return model;
}

}  // namespace lyr::testing
