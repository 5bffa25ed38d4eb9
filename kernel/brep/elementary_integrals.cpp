// With o the surface's own origin seen from c, the integral of (p - c) . n
// over a face is o . S + r A on spheres and cylinders, o . S on planes, o . S + r cos(a) A on cones (o on the axis, r
// the radius at its height, a the half angle), and o . S + m A + M K on tori, where S is the integral of n, which
// depends on the boundary alone, A the face's area and K the integral of cos v, v the angle around the tube.
//
// On surfaces that close upon themselves a boundary does not say which of two regions it bounds: A and K are known
// up to the whole surface's, and A lies between zero and the whole.

#include "kernel/brep/elementary_integrals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/geometry/angle.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

using std::numbers::pi;

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

}  // namespace

FaceIntegrals elementary_integrals(const Surface& surface, const FaceNodes& nodes, double sense,
                                   const Point3& c) {
    const Vector3 outward = vector_area(nodes, c);
    struct Visitor {
        const FaceNodes& nodes;
        double sense;
        Vector3 outward;
        Point3 c;
        FaceIntegrals operator()(const Plane&) const { return {}; }
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
        FaceIntegrals operator()(const SharedBSplineSurface&) const { return {}; }
    };
    return std::visit(Visitor{nodes, sense, outward, c}, surface);
}

}  // namespace lyr
