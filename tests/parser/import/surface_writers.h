// Faces on surfaces that a test writes, as a file has them.

#pragma once

#include <functional>

#include "checks.h"

namespace lyr::test {

using Write = std::function<int(StepText&)>;

// A face on the surface that `surface` writes, bounded by straight edges from point to point.
inline StepText face_step(const Write& surface, const std::vector<Point3>& corners,
                          bool same_sense = true) {
    StepText step;
    std::vector<int> vertices, uses;
    for (const Point3& corner : corners) vertices.push_back(step.vertex(corner));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t next = (i + 1) % corners.size();
        const int line = step.line(corners[i], corners[next]);
        uses.push_back(step.oriented(step.edge(vertices[i], vertices[next], line), true));
    }
    const int face = step.face({step.bound(step.loop(uses))}, surface(step), same_sense);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")},
                        step.millimetres());
    return step;
}

inline Face face_on(const Write& surface, const std::vector<Point3>& corners,
                    bool same_sense = true) {
    return imported(face_step(surface, corners, same_sense)).model.faces.at(0);
}

// What the file says is outward at a point of the surface.
inline Vector3 stated_normal(const Face& face, const Point3& at) {
    const Vector3 along = normal(face.surface, invert(face.surface, at));
    return face.same_sense ? along : Vector3(-along);
}

inline bool is_on(const Face& face, const Point3& p) {
    return near(evaluate(face.surface, invert(face.surface, p)), p);
}

inline int origin_placement(StepText& step) {
    return step.placement({0, 0, 0}, Vector3::UnitZ(), Vector3::UnitX());
}

inline Write circle(const Point3& centre, const Vector3& z, const Vector3& x, double radius) {
    return [=](StepText& step) {
        const int at = step.placement(centre, z, x);
        return step.add("CIRCLE(''," + StepText::ref(at) + "," + StepText::num(radius) + ")");
    };
}
inline Write line(const Point3& from, const Point3& to) {
    return [=](StepText& step) { return step.line(from, to); };
}

inline Write extrusion(const Write& curve, const Vector3& along) {
    return [=](StepText& step) {
        const int swept = curve(step), direction = step.direction(along);
        const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",2.5)");
        return step.add("SURFACE_OF_LINEAR_EXTRUSION(''," + StepText::ref(swept) + "," +
                        StepText::ref(vector) + ")");
    };
}

inline Write revolution(const Write& curve, const Point3& origin, const Vector3& along) {
    return [=](StepText& step) {
        const int swept = curve(step), at = step.point(origin), z = step.direction(along);
        const int axis =
            step.add("AXIS1_PLACEMENT(''," + StepText::ref(at) + "," + StepText::ref(z) + ")");
        return step.add("SURFACE_OF_REVOLUTION(''," + StepText::ref(swept) + "," +
                        StepText::ref(axis) + ")");
    };
}

inline Write trimmed(const Write& basis, const Point3& from, const Point3& to, bool agrees) {
    return [=](StepText& step) {
        const int curve = basis(step), a = step.point(from), b = step.point(to);
        return step.add("TRIMMED_CURVE(''," + StepText::ref(curve) + ",(" + StepText::ref(a) +
                        "),(" + StepText::ref(b) + ")," + StepText::flag(agrees) + ",.CARTESIAN.)");
    };
}

}  // namespace lyr::test
