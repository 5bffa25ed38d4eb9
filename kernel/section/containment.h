// Is a closed component of a section, which no edge of the face crosses, in the face or out of it?
//
// Contract
//  1. The answer is topological: it does not change as long as the component crosses no edge.
//  2. Loops may wind around the surface, hold poles or an apex, or be missing (a whole sphere, a whole torus).
//
// Method, after preparing the boundary once as closed outlines on the surface (dense enough that no two neighbours
// are an eighth of a turn apart; an edge that the face uses in both directions, a seam, bounds nothing and is left
// out):
//   cylinder, cone   the component is in the face if the loops on its unbounded side wind around the axis
//   sphere           every outline lies above the component or below; seen in stereographic projection from the
//                    sphere's highest or lowest point, whichever is on the component's side of it, it runs
//                    clockwise: the point at infinity is on its left. So too on either sheet of a torus whose tube
//                    crosses the axis, projected from the component itself
//   torus, B-spline  the nearest loop along v (the tube's circle), or else along u, has the face on the near side;
//                    with neither, every loop is a hole

#pragma once

#include <array>
#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

// From one point of an outline to the next in the surface's parameters, `by` the short way round.
struct UvStep {
    Point2 from, to, by;
};

// One closed outline, in the form that its surface's method asks for.
struct Outline {
    double height_mm = 0;             // of any vertex: its level
    int winding = 0;                  // cylinder, cone: around the axis
    std::vector<Vector3> directions;  // sphere: on the unit sphere; the first follows the last
    std::vector<UvStep> steps;        // torus, B-spline; cylinder and cone if asked for
};

class Containment {
public:
    // `for_parameters`: holds_parameters() will be asked of any point, of cylinders and cones too.
    Containment(const Model& model, FaceId face, const std::vector<double>& vertex_level_mm,
                bool for_parameters = false);

    // `point` is on the component, whose plane is at z: outlines at that level are below it.
    bool holds(const Point3& point, double z_mm) const;

    // Whether the face has a point of a torus or B-spline surface, given by its parameters.
    bool holds_parameters(const Point2& uv) const;

    // Whether the face of a cone reaches its apex.
    bool holds_apex() const;

private:
    bool on_cylinder(double z_mm) const;
    bool on_cone(const Cone& cone, double z_mm) const;
    bool on_sphere(double z_mm) const;
    bool on_spindle(const Point3& point) const;
    double sense_of_parameters() const;
    Outline prepared(const std::vector<Point3>& points, double height_mm) const;

    Surface surface_;
    bool for_parameters_, same_sense_;
    std::array<double, 2> period_{0, 0};  // of the surface's parameters; 0: not closed
    std::vector<Outline> outlines_;
};

}  // namespace lyr
