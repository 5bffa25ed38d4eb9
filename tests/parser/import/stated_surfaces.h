// Surfaces as a file states them, each with the formula that ISO 10303-42 gives it, for tests.

#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "flat_curves.h"
#include "kernel/geometry/bspline_surface.h"

namespace lyr::test {

using Formula = std::function<Point3(const Point2&)>;

// A surface as a file states it and by the formulas of ISO 10303-42.
struct Stated {
    std::string name;
    Write write;
    Formula at;
    Point2 from, to;  // parameters within which curves are put
};

inline Point3 turned(const Point3& p, double angle) {
    return Eigen::AngleAxisd(angle, Vector3::UnitZ()) * p;
}

// Where surface() puts its surfaces.
inline const Point3 origin(1, 2, 3);

// The profile of sweeps: y is to be far from the axis.
inline const std::vector<Point3> profile{{4, 0, 0}, {6, 1, 2}, {3, 2, 3}, {5, 2, 6}};
inline Point3 profile_at(double t) {
    const double r = 1 - t;
    return r * r * r * profile[0] + 3 * r * r * t * profile[1] + 3 * r * t * t * profile[2] +
           t * t * t * profile[3];
}
inline int write_profile(StepText& step) {
    std::vector<int> ids;
    for (const Point3& p : profile) ids.push_back(step.point(p));
    return step.add("B_SPLINE_CURVE_WITH_KNOTS('',3," + StepText::refs(ids) +
                    ",.UNSPECIFIED.,.F.,.U.,(4,4),(0.,1.),.UNSPECIFIED.)");
}

inline Stated extrusion() {
    const Vector3 along = Vector3(0.2, 1, 0.1).normalized();
    return {"extrusion",
            [=](StepText& step) {
                const int curve = write_profile(step), direction = step.direction(along);
                const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",2.5)");
                return step.add("SURFACE_OF_LINEAR_EXTRUSION(''," + StepText::ref(curve) + "," +
                                StepText::ref(vector) + ")");
            },
            [=](const Point2& uv) -> Point3 { return profile_at(uv.x()) + 2.5 * uv.y() * along; },
            {0.1, -1},
            {0.9, 3}};
}

inline Stated extruded_circle() {
    return {"extruded circle",
            [](StepText& step) {
                const int at = step.placement(origin, Vector3::UnitZ(), Vector3::UnitX());
                const int curve = step.add("CIRCLE(''," + StepText::ref(at) + ",2.)");
                const int direction = step.direction({0, 0.6, 0.8});
                const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",1.)");
                return step.add("SURFACE_OF_LINEAR_EXTRUSION(''," + StepText::ref(curve) + "," +
                                StepText::ref(vector) + ")");
            },
            [](const Point2& uv) -> Point3 {
                return origin + turned({2, 0, 0}, uv.x()) + uv.y() * Vector3(0, 0.6, 0.8);
            },
            {0.3, 0},
            {4, 5}};
}

inline Stated revolution() {
    return {"revolution",
            [](StepText& step) {
                const int curve = write_profile(step), at = step.point({0, 0, 0});
                const int z = step.direction(Vector3::UnitZ());
                const int axis = step.add("AXIS1_PLACEMENT(''," + StepText::ref(at) + "," +
                                          StepText::ref(z) + ")");
                return step.add("SURFACE_OF_REVOLUTION(''," + StepText::ref(curve) + "," +
                                StepText::ref(axis) + ")");
            },
            [](const Point2& uv) { return turned(profile_at(uv.y()), uv.x()); },
            {0.5, 0.1},
            {4, 0.95}};
}

inline Stated cone(double half) {
    return {"cone",
            surface("CONICAL_SURFACE", ",9.," + StepText::num(half)),
            [=](const Point2& uv) -> Point3 {
                const double radius = 9 + uv.y() * std::tan(half);
                return origin + turned({radius, 0, uv.y()}, uv.x());
            },
            {0.5, -1},
            {5, 6}};
}

inline Stated bspline() {
    const std::vector<Point3> net{{0, 0, 0}, {0, 1, 0}, {0, 2, 1}, {3, 0, 2}, {3, 1, 4},
                                  {3, 2, 0}, {7, 0, 2}, {7, 1, 4}, {7, 2, 0}};
    const BSplineSurface kernel{1, 2, 3, 3, {0, 0, 1, 2, 2}, {0, 0, 0, 1, 1, 1}, net, {}};
    return {"B-spline",
            [=](StepText& step) {
                std::string text = "B_SPLINE_SURFACE_WITH_KNOTS('',1,2,(";
                for (std::size_t i = 0; i < 3; ++i) {
                    std::vector<int> ids;
                    for (std::size_t j = 0; j < 3; ++j) ids.push_back(step.point(net[3 * i + j]));
                    text += (i > 0 ? "," : "") + StepText::refs(ids);
                }
                return step.add(text +
                                "),.UNSPECIFIED.,.F.,.F.,.U.,(2,1,2),(3,3),(0.,1.,2.),"
                                "(0.,1.),.UNSPECIFIED.)");
            },
            [=](const Point2& uv) { return evaluate(kernel, uv); },
            {0.2, 0.1},
            {1.9, 0.9}};
}

inline Stated offset(const Stated& basis, double distance) {
    return {"offset of " + basis.name,
            [=](StepText& step) {
                return step.add("OFFSET_SURFACE(''," + StepText::ref(basis.write(step)) + "," +
                                StepText::num(distance) + ",.F.)");
            },
            [=](const Point2& uv) -> Point3 {
                // By fourth-order differences: exact to 1e-10.
                constexpr double h = 1e-3;
                const auto slope = [&](const Vector2& by) -> Vector3 {
                    return (8 * (basis.at(uv + by) - basis.at(uv - by)) -
                            (basis.at(uv + 2 * by) - basis.at(uv - 2 * by))) /
                           (12 * h);
                };
                const Vector3 out = slope(h * Vector2::UnitX()).cross(slope(h * Vector2::UnitY()));
                return basis.at(uv) + distance * out.normalized();
            },
            basis.from, basis.to};
}

// In reverse along u, from its corner or (against the standard, but written) in its basis' own parameters.
inline Stated trimmed(const Stated& basis, bool from_zero) {
    const Point2 low = basis.from, high = basis.to;
    const auto write = [=](StepText& step) {
        const auto [u, v, w] = std::tuple(from_zero ? high.x() : low.x(), low.y(), high.y());
        return step.add("RECTANGULAR_TRIMMED_SURFACE(''," + StepText::ref(basis.write(step)) + "," +
                        StepText::num(u) + "," + StepText::num(from_zero ? low.x() : high.x()) +
                        "," + StepText::num(v) + "," + StepText::num(w) + "," +
                        StepText::flag(!from_zero) + ",.T.)");
    };
    if (!from_zero) return {"trimmed, as its basis, " + basis.name, write, basis.at, low, high};
    return {"trimmed " + basis.name, write,
            [=](const Point2& uv) {
                return basis.at({high.x() - uv.x(), low.y() + uv.y()});
            },
            Point2(0, 0), high - low};
}

// Mirrored and twice as large.
inline Stated replica(const Stated& basis) {
    return {"replica of " + basis.name,
            [=](StepText& step) {
                const int x = step.direction(-Vector3::UnitX()),
                          y = step.direction(Vector3::UnitY()),
                          z = step.direction(Vector3::UnitZ()), at = step.point({10, 0, 0});
                const int to = step.add("CARTESIAN_TRANSFORMATION_OPERATOR_3D(''," +
                                        StepText::ref(x) + "," + StepText::ref(y) + "," +
                                        StepText::ref(at) + ",2.," + StepText::ref(z) + ")");
                return step.add("SURFACE_REPLICA(''," + StepText::ref(basis.write(step)) + "," +
                                StepText::ref(to) + ")");
            },
            [=](const Point2& uv) -> Point3 {
                const Point3 p = basis.at(uv);
                return {10 - 2 * p.x(), 2 * p.y(), 2 * p.z()};
            },
            basis.from, basis.to};
}

inline std::vector<Stated> surfaces() {
    const Stated cylinder{"cylinder",
                          surface("CYLINDRICAL_SURFACE", ",2."),
                          [](const Point2& uv) -> Point3 {
                              return origin + turned({2, 0, uv.y()}, uv.x());
                          },
                          {-1, -3},
                          {14, 8}};
    const Stated sphere{
        "sphere",
        surface("SPHERICAL_SURFACE", ",2."),
        [](const Point2& uv) -> Point3 {
            return origin + turned({2 * std::cos(uv.y()), 0, 2 * std::sin(uv.y())}, uv.x());
        },
        {0.2, -1.2},
        {5, 1.3}};
    const Stated torus{
        "torus",
        surface("TOROIDAL_SURFACE", ",5.,2."),
        [](const Point2& uv) -> Point3 {
            return origin + turned({5 + 2 * std::cos(uv.y()), 0, 2 * std::sin(uv.y())}, uv.x());
        },
        {0.2, -1},
        {4, 9}};
    return {cylinder,
            cone(0.5),
            cone(-0.5),
            sphere,
            torus,
            bspline(),
            extrusion(),
            extruded_circle(),
            revolution(),
            offset(cylinder, 1.5),
            offset(cylinder, -0.5),
            offset(cone(0.5), 2),
            offset(cone(-0.5), -2),
            offset(sphere, -0.5),
            offset(torus, 1),
            offset(extrusion(), 0.3),
            offset(extruded_circle(), -0.4),
            offset(revolution(), -0.2),
            offset(offset(revolution(), 1), -0.8),
            trimmed(cylinder, true),
            trimmed(cylinder, false),
            trimmed(offset(torus, 1), true),
            replica(cylinder),
            replica(offset(extrusion(), 0.3)),
            offset(replica(extrusion()), 0.6),
            offset(trimmed(extruded_circle(), true), 0.4)};
}

}  // namespace lyr::test
