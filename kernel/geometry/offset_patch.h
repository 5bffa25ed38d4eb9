// One patch of an offset surface: points of the exact offset, the polynomial through them, and what is proved of it.
//
// Contract
//  1. error_bound_mm() is no less than |A - (S + d n)| anywhere on the piece, at the same parameters; facing() is the
//     sign of d/du x d/dv of A along n everywhere on it, if there is one.
//  2. The normal of a pole, where a whole side of the surface is one point, is the limit from inside.

#pragma once

#include <array>
#include <vector>

#include "kernel/geometry/bernstein_tensor.h"
#include "kernel/geometry/bspline_surface.h"

namespace lyr::offset_patch {

// A share of a knot span, from `low` to `high` of it.
struct Stretch {
    std::size_t span;
    double low, high;
};

// A part of a Bezier patch, about an origin of its own, on the unit square.
struct Piece {
    Point3 origin;
    bernstein::Tensor3 point;  // w S
    bernstein::Tensor weight;
    bernstein::Tensor3 normal = {};  // the direction of d/du x d/dv, for what part() gives
    std::array<bool, 4> pole = {};   // by bernstein::sides
};

Piece piece_of(const BezierPatch& patch, bool is_rational);
Piece part(const Piece& whole, const Stretch& u, const Stretch& v);

Point3 surface_point(const Piece& piece, double u, double v);  // about its origin
Vector3 unit_normal(const Piece& piece, double u, double v);

// Control points of a polynomial patch.
struct Net {
    int degree_u, degree_v;
    std::vector<Point3> points;  // that of (i, j) at [i * (degree_v + 1) + j]
};

// Through the exact offset at the nodes of interpolation.h.
Net interpolated(const Piece& piece, double distance_mm, int degree_u, int degree_v);

// Makes one point of the control points on a side, that of the first one, if they are that but for round-off.
void collapse(Net& net, const bernstein::Side& side);

double error_bound_mm(const Piece& piece, const Net& net, double distance_mm);

enum class Sign { positive, negative, mixed, unknown };
Sign facing(const Piece& piece, const Net& net);

// How much the highest coefficient of the net's polynomials moves the points, along u and along v: what a finer grid
// that way would gain.
Vector2 unresolved_mm(const Net& net);

}  // namespace lyr::offset_patch
