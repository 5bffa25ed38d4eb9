// Points of curves and surfaces by their formulas, as templates: with numbers for values, with Series for bounds
// (kernel/geometry/taylor.h).
//
// `inside` says which piece of a B-spline is meant: a parameter inside it. At its ends, and where bounds reach beyond
// them, the piece is continued.

#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/curve_approximation.h"
#include "parser/import/parameter_space.h"

namespace lyr::importer {

// Coordinates within a frame as a vector of space: a point's, or a direction's.
template <class T>
Triple<T> in_frame(const Frame& frame, const Triple<T>& local, bool is_point) {
    Triple<T> result;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        result[i] = T(is_point ? frame.origin[k] : 0.0) + T(frame.x[k]) * local[0] +
                    T(frame.y[k]) * local[1] + T(frame.z[k]) * local[2];
    }
    return result;
}

// The other way: coordinates within the frame.
template <class T>
Triple<T> of_frame(const Frame& frame, const Triple<T>& global, bool is_point) {
    Triple<T> offset = global;
    for (std::size_t i = 0; is_point && i < 3; ++i)
        offset[i] = global[i] - T(frame.origin[static_cast<Eigen::Index>(i)]);
    const auto along = [&](const Vector3& axis) -> T {
        return T(axis.x()) * offset[0] + T(axis.y()) * offset[1] + T(axis.z()) * offset[2];
    };
    return {along(frame.x), along(frame.y), along(frame.z)};
}

template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
Triple<T> moved_along(const Triple<T>& point, const Triple<T>& direction, double distance) {
    using std::sqrt;
    const T length = sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                          direction[2] * direction[2]);
    Triple<T> result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = point[i] + T(distance) * direction[i] / length;
    return result;
}

// De Casteljau's algorithm on a line of homogeneous points; what is left of it are the two before the last.
template <class T>
using Homogeneous = std::array<T, 4>;

template <class T>
Homogeneous<T> between(const Homogeneous<T>& a, const Homogeneous<T>& b, const T& share) {
    Homogeneous<T> result;
    for (std::size_t c = 0; c < 4; ++c) result[c] = a[c] + share * (b[c] - a[c]);
    return result;
}

template <class T>
void reduce(std::vector<Homogeneous<T>>& line, const T& share, std::size_t left) {
    for (; line.size() > left; line.pop_back()) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
            line[i] = between(line[i], line[i + 1], share);
    }
}

template <class T>
Homogeneous<T> homogeneous(const Eigen::Vector4d& c) {
    return {T(c[0]), T(c[1]), T(c[2]), T(c[3])};
}

// A point on its way, and where it goes (not how fast).
template <class T>
struct Moving {
    Triple<T> point, direction;
};

template <class T>
Moving<T> moving(const BezierPiece& piece, const T& t) {
    const T share = (t - T(piece.from)) / T(piece.to - piece.from);
    std::vector<Homogeneous<T>> line;
    for (const Eigen::Vector4d& c : piece.control_points) line.push_back(homogeneous<T>(c));
    reduce(line, share, 2);
    const Homogeneous<T> at = between(line[0], line[1], share);
    Moving<T> result;
    for (std::size_t i = 0; i < 3; ++i) {
        result.point[i] = at[i] / at[3];
        result.direction[i] = (line[1][i] - line[0][i]) * at[3] - at[i] * (line[1][3] - line[0][3]);
    }
    return result;
}

// The knot span that holds a parameter: its index.
inline std::size_t span_at(const std::vector<double>& knots, int degree, std::size_t count,
                           double inside) {
    const auto first = knots.begin() + degree + 1;
    const auto last = knots.begin() + static_cast<std::ptrdiff_t>(count);
    return static_cast<std::size_t>(std::upper_bound(first, last, inside) - knots.begin()) - 1;
}

// How far to go back into the domain of what repeats.
inline double whole_turns(double inside, double start, double end) {
    return std::floor((inside - start) / (end - start)) * (end - start);
}

template <class T>
Moving<T> moving(const BSplineCurve& c, const T& t, double inside) {
    const double turns = c.closed ? whole_turns(inside, c.domain_start(), c.domain_end()) : 0.0;
    const std::size_t span = span_at(c.knots, c.degree, c.control_points.size(), inside - turns);
    return moving(bezier_pieces(c, c.knots[span], c.knots[span + 1]).front(), t - T(turns));
}

template <class T>
struct MovingOn {
    T t;
    double inside;

    Moving<T> in_plane(const Frame& frame, const T& x, const T& y, const T& dx, const T& dy) const {
        const T none(0.0);
        return {in_frame<T>(frame, {x, y, none}, true), in_frame<T>(frame, {dx, dy, none}, false)};
    }
    Moving<T> operator()(const Line& c) const {
        const Frame frame{c.origin, c.direction, Vector3::Zero(), Vector3::Zero()};
        return in_plane(frame, t, T(0.0), T(1.0), T(0.0));
    }
    Moving<T> operator()(const Circle& c) const {
        return (*this)(Ellipse{c.frame, c.radius_mm, c.radius_mm});
    }
    Moving<T> operator()(const Ellipse& c) const {
        using std::cos;
        using std::sin;
        const T x(c.semi_x_mm), y(c.semi_y_mm);
        return in_plane(c.frame, x * cos(t), y * sin(t), T(0.0) - x * sin(t), y * cos(t));
    }
    Moving<T> operator()(const Parabola& c) const {
        const T focal(c.focal_mm), twice(2 * c.focal_mm);
        return in_plane(c.frame, focal * t * t, twice * t, twice * t, twice);
    }
    Moving<T> operator()(const Hyperbola& c) const {
        using std::cosh;
        using std::sinh;
        const T x(c.semi_x_mm), y(c.semi_y_mm);
        return in_plane(c.frame, x * cosh(t), y * sinh(t), x * sinh(t), y * cosh(t));
    }
    Moving<T> operator()(const BSplineCurve& c) const { return moving(c, t, inside); }
};

template <class T>
struct PointOn {
    T u, v;
    Point2 inside;
    double offset_mm;

    // Straight up from the frame, or around it.
    Triple<T> around(const Frame& frame, const T& radius, const T& height) const {
        using std::cos;
        using std::sin;
        return in_frame<T>(frame, {radius * cos(u), radius * sin(u), height}, true);
    }
    Triple<T> operator()(const Plane& s) const {
        return in_frame<T>(s.frame, {u, v, T(0.0)}, true);
    }
    Triple<T> operator()(const Cylinder& s) const { return around(s.frame, T(s.radius_mm), v); }
    Triple<T> operator()(const Cone& s) const {
        return around(s.frame, T(s.radius_mm) + v * T(std::tan(s.half_angle_rad)), v);
    }
    Triple<T> operator()(const Sphere& s) const { return (*this)(Torus{s.frame, 0, s.radius_mm}); }
    Triple<T> operator()(const Torus& s) const {
        using std::cos;
        using std::sin;
        const T tube(s.minor_mm);
        return around(s.frame, T(s.major_mm) + tube * cos(v), tube * sin(v));
    }
    Triple<T> operator()(const SharedBSplineSurface& shared) const {
        const BSplineSurface& s = *shared;
        const double turns_u = s.closed_u ? whole_turns(inside.x(), s.start_u(), s.end_u()) : 0.0;
        const double turns_v = s.closed_v ? whole_turns(inside.y(), s.start_v(), s.end_v()) : 0.0;
        const BezierPatch patch =
            bezier_patch(s, span_at(s.knots_u, s.degree_u, s.count_u, inside.x() - turns_u),
                         span_at(s.knots_v, s.degree_v, s.count_v, inside.y() - turns_v));
        const T share_u = (u - T(turns_u + patch.from_u)) / T(patch.to_u - patch.from_u);
        const T share_v = (v - T(turns_v + patch.from_v)) / T(patch.to_v - patch.from_v);
        std::vector<Homogeneous<T>> across, line;
        const auto order_v = static_cast<std::size_t>(patch.degree_v + 1);
        for (std::size_t k = 0; k < patch.control_points.size(); ++k) {
            line.push_back(homogeneous<T>(patch.control_points[k]));
            if (line.size() < order_v) continue;
            reduce(line, share_v, 1);
            across.push_back(line[0]);
            line.clear();
        }
        reduce(across, share_u, 1);
        const Homogeneous<T>& at = across[0];
        return {at[0] / at[3], at[1] / at[3], at[2] / at[3]};
    }
    Triple<T> operator()(const Extrusion& s) const {
        const Moving<T> at = std::visit(MovingOn<T>{u, inside.x()}, s.curve);
        const Triple<T> up{T(s.direction.x()), T(s.direction.y()), T(s.direction.z())};
        Triple<T> point;
        for (std::size_t i = 0; i < 3; ++i) point[i] = at.point[i] + v * up[i];
        if (offset_mm == 0) return point;
        return moved_along(point, cross(at.direction, up), offset_mm);
    }
    Triple<T> operator()(const Revolution& s) const {
        using std::cos;
        using std::sin;
        const Moving<T> at = std::visit(MovingOn<T>{v, inside.y()}, s.curve);
        const auto turned = [&](const Triple<T>& a) -> Triple<T> {
            return {a[0] * cos(u) - a[1] * sin(u), a[0] * sin(u) + a[1] * cos(u), a[2]};
        };
        Triple<T> point = turned(of_frame(s.axis, at.point, true));
        if (offset_mm != 0) {
            const Triple<T> around{T(0.0) - point[1], point[0], T(0.0)};
            const Triple<T> along = turned(of_frame(s.axis, at.direction, false));
            point = moved_along(point, cross(around, along), offset_mm);
        }
        return in_frame(s.axis, point, true);
    }
};

// At parameters of the basis.
template <class T>
Triple<T> point_on(const ParameterSpace& space, const T& u, const T& v, const Point2& inside) {
    const Triple<T> at = std::visit(PointOn<T>{u, v, inside, space.offset_mm}, space.basis);
    const Eigen::Matrix3d linear = space.to_space.linear();
    return in_frame(
        Frame{space.to_space.translation(), linear.col(0), linear.col(1), linear.col(2)}, at, true);
}

}  // namespace lyr::importer
