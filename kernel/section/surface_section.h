// The untrimmed section of a surface with the plane z = h: a set of components, each a curve with
// a key that rises along it with the material on the left.
//
// Contract
//  1. The direction of rising key is z x n, n the outward normal: along it the solid is on the left.
//  2. locate() names the component that a crossing lies on and its key there. It needs no tolerance: where two
//     components come together at a level line of the surface (the top of a lying cylinder, of an upright torus'
//     tube), the side on which the crossing's whole monotone piece of edge lies decides.
//  3. A closed component repeats after period(); the key of a point is unique within a period.
//  4. at(component, key) is on surface and plane (to round-off; on a tracked curve, to its chord error), with the
//     tangent of rule 1.
//  5. trace() appends segments from `start` to `end` (points of the component at these keys, up to the model's
//     inaccuracy, which is spread evenly over the span): lines for lines, one arc for circles, fitted arcs within
//     tolerance.fit_mm() for the rest. It returns false where an end is so far off its component that only a straight
//     line could be drawn.
//
//   plane      one line
//   cylinder   across: circle; oblique: ellipse; along: two lines
//   cone       across: circle; else ellipse, parabola or hyperbola, all by the angle about the axis;
//              through the apex: two lines
//   sphere     circle
//   torus      across: two circles; else by the angle about the tube, of which the section is an explicit function
//   B-spline   tracked level curves, by the length along their chords (level_curves.h)

#pragma once

#include <array>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/contour/arc.h"
#include "kernel/contour/contour.h"
#include "kernel/contour/fit.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/level_curves.h"

namespace lyr {

struct Place {
    int component = 0;
    double key = 0;
};

// A straight section of a plane.
struct LineSection {
    Vector2 direction;
};

// Two lines along a level cylinder; component 0 is to the left of the axis, 1 to the right.
struct GeneratorSection {
    Point2 origin;
    Vector2 axis;
    double sense;  // +1: the outward normal points away from the axis
};

// One circle, or two about one centre: component 0 the outer, 1 the inner.
struct CircleSection {
    Point2 centre;
    int count;
    std::array<double, 2> radius_mm;
    std::array<bool, 2> counter_clockwise;
    double border_mm;  // farther from the centre is the outer one
};

struct EllipseSection {
    Point2 centre;
    Vector2 major, minor;  // unit; minor is major turned left
    double semi_major_mm, semi_minor_mm;
    Point3 on_axis;
    Vector3 across;  // unit, perpendicular to the axis, above `major`
    double sense;
};

// Basis of an axis that is not upright: `axis` = lean * level + rise * z.
struct LeaningBasis {
    Vector3 axis, across, side;  // right-handed: across x side = axis; side is horizontal
    double lean, rise;
};

struct ConeSection {
    Point3 apex;
    LeaningBasis basis;
    double cosine, sine;  // of the half angle
    double height_mm;     // of the plane over the apex
    bool closed;
    double middle_rad;  // keys run half a turn to each side of this angle
    double sense;
};

struct TorusSection {
    Point3 centre;
    LeaningBasis basis;  // with rise >= 0
    double major_mm, minor_mm;
    bool inner_sheet;
    double height_mm;  // of the plane over the centre
    double sense;
    // Components: each an interval of the tube's angle, or (both_ways) a whole turn of it, once with the axis
    // angle positive and once negative.
    int count;
    bool both_ways;
    std::array<double, 2> from_rad, to_rad;
};

// The plane touches the surface in no more than round-off: crossings are joined by lines.
struct TouchSection {};

struct FreeformSection {
    std::vector<LevelCurve> curves;
};

using SurfaceSection = std::variant<LineSection, GeneratorSection, CircleSection, EllipseSection,
                                    ConeSection, TorusSection, FreeformSection, TouchSection>;

// Of an elementary surface. `extent_mm`: how far from its origin the surface is used; a lean below resolution_mm over
// that is none.
SurfaceSection section_of(const Surface& surface, bool same_sense, double z_mm, double extent_mm);

// A crossing of the section with an edge.
struct CrossingPoint {
    Point3 point;
    Point3 on_piece;  // any other point of the same monotone piece of the edge
};

Place locate(const SurfaceSection& section, const CrossingPoint& crossing);
int component_count(const SurfaceSection& section);
// 0 for an open component.
double period(const SurfaceSection& section, int component);
CurvePoint at(const SurfaceSection& section, const Place& place);

// False where a branch of a hyperbola goes to infinity between the two keys, or does not reach them: then the crossings that
// they are of lie on the cone's other half, or off the cone.
bool is_unbroken(const SurfaceSection& section, double from, double to);

bool trace(const SurfaceSection& section, int component, double from, double to,
           const Point2& start, const Point2& end, const Tolerance& tolerance,
           std::vector<Segment>& out);

// A whole closed component as a contour.
Contour whole_component(const SurfaceSection& section, int component, const Tolerance& tolerance);

// For section_of(): the torus, in torus_section.cpp.
SurfaceSection torus_section(const Torus& torus, bool same_sense, double z_mm, double extent_mm);
Place locate(const TorusSection& section, const CrossingPoint& crossing);
CurvePoint at(const TorusSection& section, const Place& place);
LeaningBasis leaning_basis(const Vector3& axis);

// Tracked curves, in freeform_section.cpp.
Place locate(const FreeformSection& section, const CrossingPoint& crossing);
CurvePoint at(const FreeformSection& section, const Place& place);
void trace(const FreeformSection& section, int component, double from, double to,
           const Point2& start, const Point2& end, double allowed_mm, std::vector<Segment>& out);

}  // namespace lyr
