// Edges of which only a curve in the parameters of a surface is known, for tests.

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "checks.h"

namespace lyr::test {

using Write = std::function<int(StepText&)>;

inline int flat_point(StepText& step, double u, double v) {
    return step.add("CARTESIAN_POINT('',(" + StepText::num(u) + "," + StepText::num(v) + "))");
}

inline Write flat_line(double u, double v, double along_u, double along_v) {
    return [=](StepText& step) {
        const int at = flat_point(step, u, v);
        const int direction = step.add("DIRECTION('',(" + StepText::num(along_u) + "," +
                                       StepText::num(along_v) + "))");
        const int vector = step.add("VECTOR(''," + StepText::ref(direction) + ",1.)");
        return step.add("LINE(''," + StepText::ref(at) + "," + StepText::ref(vector) + ")");
    };
}

inline Write flat_spline(const std::vector<Point2>& points, const std::string& tail) {
    return [=](StepText& step) {
        std::vector<int> ids;
        for (const Point2& p : points) ids.push_back(flat_point(step, p.x(), p.y()));
        return step.add("B_SPLINE_CURVE_WITH_KNOTS('',2," + StepText::refs(ids) +
                        ",.UNSPECIFIED.,.F.,.U.," + tail + ",.UNSPECIFIED.)");
    };
}

inline Write surface(const std::string& type, const std::string& sizes) {
    return [=](StepText& step) {
        const int at = step.placement({1, 2, 3}, Vector3::UnitZ(), Vector3::UnitX());
        return step.add(type + "(''," + StepText::ref(at) + sizes + ")");
    };
}

// A face whose first edge is a curve of the surface's parameters, from `start` to `end`.
inline StepText face_step(const Write& on, const Write& flat, const Point3& start,
                          const Point3& end, bool in_degrees) {
    StepText step;
    const int basis = on(step);
    const int context =
        step.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)REPRESENTATION_CONTEXT('',''))");
    const int representation =
        step.add("DEFINITIONAL_REPRESENTATION(''," + StepText::refs({flat(step)}) + "," +
                 StepText::ref(context) + ")");
    const int pcurve =
        step.add("PCURVE(''," + StepText::ref(basis) + "," + StepText::ref(representation) + ")");
    const int a = step.vertex(start), b = step.vertex(end);
    const int edge = step.edge(a, b, pcurve), back = step.edge(b, a, step.line(end, start));
    const int face = step.face(
        {step.bound(step.loop({step.oriented(edge, true), step.oriented(back, true)}))}, basis);
    const int shell = step.add("CLOSED_SHELL(''," + StepText::refs({face}) + ")");
    const int units =
        step.context({step.si_length(".MILLI."), in_degrees ? step.degree() : step.radian()});
    step.representation({step.add("MANIFOLD_SOLID_BREP(''," + StepText::ref(shell) + ")")}, units);
    return step;
}

inline Edge edge_on(const Write& on, const Write& flat, const Point3& start, const Point3& end,
                    bool in_degrees = false) {
    const Imported result = imported(face_step(on, flat, start, end, in_degrees));
    CHECK(result.diagnostics.empty());
    const Edge edge = result.model.edges.at(0);
    CHECK(near(evaluate(edge.curve, edge.t_start), start));
    CHECK(near(evaluate(edge.curve, edge.t_end), end));
    return edge;
}

inline Point3 middle(const Edge& edge) {
    return evaluate(edge.curve, 0.5 * (edge.t_start + edge.t_end));
}

}  // namespace lyr::test
