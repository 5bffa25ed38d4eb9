// Elementary curves in closed form, and the dispatch to B-splines.
//
// Along an elementary curve the height is a short formula of the parameter: linear on a line, a sinusoid on
// circles and ellipses, a quadratic on a parabola, a cosh-sinh sum on a hyperbola. Extrema and the inverse follow
// exactly; where the inverse has two branches, the middle of the given stretch says which one is meant.

#include "kernel/geometry/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/geometry/angle.h"
#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/height_turns.h"
#include "kernel/geometry/root.h"
#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

using std::numbers::pi;

// Circles are ellipses whose semi-axes agree; both are handled by the same formulas.
struct SemiAxes {
    double x, y;
};
SemiAxes semi_axes(const Circle& c) {
    return {c.radius_mm, c.radius_mm};
}
SemiAxes semi_axes(const Ellipse& e) {
    return {e.semi_x_mm, e.semi_y_mm};
}

template <class T>
constexpr bool is_elliptic = std::is_same_v<T, Circle> || std::is_same_v<T, Ellipse>;

Point3 in_plane(const Frame& frame, double x, double y) {
    return frame.origin + x * frame.x + y * frame.y;
}

// --- evaluate, derivative ---

Point3 point_at(const Line& c, double t) {
    return c.origin + t * c.direction;
}
Point3 point_at(const Parabola& c, double t) {
    return in_plane(c.frame, c.focal_mm * t * t, 2 * c.focal_mm * t);
}
Point3 point_at(const Hyperbola& c, double t) {
    return in_plane(c.frame, c.semi_x_mm * std::cosh(t), c.semi_y_mm * std::sinh(t));
}
Point3 point_at(const BSplineCurve& c, double t) {
    return evaluate(c, t);
}
template <class T>
requires is_elliptic<T> Point3 point_at(const T& c, double t) {
    const SemiAxes semi = semi_axes(c);
    return in_plane(c.frame, semi.x * std::cos(t), semi.y * std::sin(t));
}

Vector3 tangent_at(const Line& c, double) {
    return c.direction;
}
Vector3 tangent_at(const Parabola& c, double t) {
    return 2 * c.focal_mm * (t * c.frame.x + c.frame.y);
}
Vector3 tangent_at(const Hyperbola& c, double t) {
    return c.semi_x_mm * std::sinh(t) * c.frame.x + c.semi_y_mm * std::cosh(t) * c.frame.y;
}
Vector3 tangent_at(const BSplineCurve& c, double t) {
    return derivative(c, t);
}
template <class T>
requires is_elliptic<T> Vector3 tangent_at(const T& c, double t) {
    const SemiAxes semi = semi_axes(c);
    return -semi.x * std::sin(t) * c.frame.x + semi.y * std::cos(t) * c.frame.y;
}

// --- invert ---

// The first-quadrant angle of the ellipse's point nearest to (x, y), both >= 0. The slope of the squared
// distance, (b^2 - a^2) sin cos + a x sin - b y cos, changes sign once in the quadrant unless an end is nearest.
double nearest_quadrant_angle(double a, double b, double x, double y) {
    if (a < b) return pi / 2 - nearest_quadrant_angle(b, a, y, x);
    const double focal_square = (a - b) * (a + b);
    if (y == 0) return a * x < focal_square ? std::acos(a * x / focal_square) : 0;
    if (x == 0) return pi / 2;
    const auto f = [&](double t) {
        const double s = std::sin(t), c = std::cos(t);
        return std::pair(a * x * s - b * y * c - focal_square * s * c,
                         a * x * c + b * y * s - focal_square * (c - s) * (c + s));
    };
    return bracketed_root(f, 0, pi / 2, false, std::atan2(a * y, b * x), 0);
}

double parameter_of(const Line& c, const Point3& point) {
    return (point - c.origin).dot(c.direction);
}
double parameter_of(const Circle& c, const Point3& point) {
    const Vector3 offset = point - c.frame.origin;
    return direction_angle(offset.dot(c.frame.y), offset.dot(c.frame.x));
}
double parameter_of(const Ellipse& c, const Point3& point) {
    const Point3 local = c.frame.to_local(point);
    const double angle =
        nearest_quadrant_angle(c.semi_x_mm, c.semi_y_mm, std::abs(local.x()), std::abs(local.y()));
    return direction_angle(local.y() < 0 ? -std::sin(angle) : std::sin(angle),
                           local.x() < 0 ? -std::cos(angle) : std::cos(angle));
}
// The slope of the squared distance is a cubic without a square term: u^3 + (2 - x/f) u - y/f. By Descartes' rule
// it has one root on the side of y, below Cauchy's bound.
double parameter_of(const Parabola& c, const Point3& point) {
    const Point3 local = c.frame.to_local(point) / c.focal_mm;
    const double p = 2 - local.x(), q = std::abs(local.y());
    if (q == 0) return std::sqrt(std::max(0.0, -p));
    const auto f = [&](double u) { return std::pair((u * u + p) * u - q, 3 * u * u + p); };
    const double bound = 1 + std::max(std::abs(p), q);
    const double u = bracketed_root(f, 0, bound, false, 0.5 * q, 0);
    return std::copysign(u, local.y());
}
// The slope of the squared distance over cosh u is (a^2 + b^2) sinh u - a x tanh u - b y: convex for u > 0 and
// negative at 0, so it has one root there, before the one that it would have with tanh u = 1.
double parameter_of(const Hyperbola& c, const Point3& point) {
    const Point3 local = c.frame.to_local(point);
    const double a = c.semi_x_mm, b = c.semi_y_mm, square = a * a + b * b;
    const double x = local.x(), y = std::abs(local.y());
    if (y == 0) return a * x > square ? std::acosh(a * x / square) : 0;
    const auto f = [&](double u) {
        const double th = std::tanh(u);
        return std::pair(square * std::sinh(u) - a * x * th - b * y,
                         square * std::cosh(u) - a * x * (1 - th * th));
    };
    const double bound = std::asinh((a * std::abs(x) + b * y) / square) + 1;
    return std::copysign(bracketed_root(f, 0, bound, false, std::asinh(y / b), 0), local.y());
}
double parameter_of(const BSplineCurve& c, const Point3& point) {
    return invert(c, point);
}

// --- heights ---

// z = level + amplitude cos(t - top)
struct Sinusoid {
    double level_mm, amplitude_mm, top;
};
template <class T>
Sinusoid heights(const T& c) {
    const SemiAxes semi = semi_axes(c);
    const double cosine = semi.x * c.frame.x.z(), sine = semi.y * c.frame.y.z();
    return {c.frame.origin.z(), std::sqrt(cosine * cosine + sine * sine), std::atan2(sine, cosine)};
}

// Candidates for extrema strictly inside (low, high); where the derivative of the height vanishes.
std::vector<double> stationary(const Line&, double, double) {
    return {};
}
template <class T>
requires is_elliptic<T> std::vector<double> stationary(const T& c, double low, double high) {
    std::vector<double> found;
    const Sinusoid z = heights(c);
    for (double k = std::floor((low - z.top) / pi); z.top + k * pi < high; ++k) {
        if (z.top + k * pi > low) found.push_back(z.top + k * pi);
    }
    return found;
}
std::vector<double> stationary(const Parabola& c, double low, double high) {
    const double t = -c.frame.y.z() / c.frame.x.z();
    if (t > low && t < high) return {t};
    return {};
}
std::vector<double> stationary(const Hyperbola& c, double low, double high) {
    const double ratio = -(c.semi_y_mm * c.frame.y.z()) / (c.semi_x_mm * c.frame.x.z());
    if (!(std::abs(ratio) < 1)) return {};
    const double t = std::atanh(ratio);
    if (t > low && t < high) return {t};
    return {};
}

template <class T>
std::vector<double> extrema(const T& c, double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    std::vector<HeightSample> samples;
    const auto sample = [&](double t) { samples.push_back({t, point_at(c, t).z()}); };
    sample(low);
    for (const double t : stationary(c, low, high)) sample(t);
    sample(high);
    std::vector<double> turns = height_turns(samples);
    if (from > to) std::reverse(turns.begin(), turns.end());
    return turns;
}
std::vector<double> extrema(const BSplineCurve& c, double from, double to) {
    return height_extrema(c, from, to);
}

double clamped(double t, double from, double to) {
    return std::clamp(t, std::min(from, to), std::max(from, to));
}

template <class T>
double nearer_end(const T& c, double from, double to, double z_mm) {
    const double off_from = std::abs(point_at(c, from).z() - z_mm);
    const double off_to = std::abs(point_at(c, to).z() - z_mm);
    return off_from <= off_to ? from : to;
}

double solve_height(const Line& c, double from, double to, double z_mm) {
    if (c.direction.z() == 0) return from;
    return clamped((z_mm - c.origin.z()) / c.direction.z(), from, to);
}
template <class T>
requires is_elliptic<T>
double solve_height(const T& c, double from, double to, double z_mm) {
    const Sinusoid z = heights(c);
    if (z.amplitude_mm == 0) return from;
    const double cosine = std::clamp((z_mm - z.level_mm) / z.amplitude_mm, -1.0, 1.0);
    // From `top` on, z falls for half a turn, then rises for half a turn.
    const double half_turns = std::floor((0.5 * (from + to) - z.top) / pi);
    const bool falls = std::fmod(half_turns, 2) == 0;
    return clamped(z.top + half_turns * pi + std::acos(falls ? cosine : -cosine), from, to);
}
// f (X u^2 + 2 Y u) = h; X u + Y = s sqrt(Y^2 + X h / f) with s the sign of the slope on the stretch.
double solve_height(const Parabola& c, double from, double to, double z_mm) {
    const double quadratic = c.frame.x.z(), linear = c.frame.y.z();
    const double h = (z_mm - c.frame.origin.z()) / c.focal_mm;
    const double root = std::sqrt(std::max(0.0, linear * linear + quadratic * h));
    const double slope = quadratic * 0.5 * (from + to) + linear < 0 ? -root : root;
    // Of the two forms of the solution, the one that adds and does not cancel.
    const bool adds = (slope > 0) != (linear > 0);
    const double u = adds ? (slope - linear) / quadratic : h / (linear + slope);
    return std::isfinite(u) ? clamped(u, from, to) : nearer_end(c, from, to, z_mm);
}
// With w = e^u: alpha w + beta / w = h, and alpha w - beta / w = s sqrt(h^2 - 4 alpha beta), s as above.
double solve_height(const Hyperbola& c, double from, double to, double z_mm) {
    const double even = c.semi_x_mm * c.frame.x.z(), odd = c.semi_y_mm * c.frame.y.z();
    const double h = z_mm - c.frame.origin.z();
    const double root = std::sqrt(std::max(0.0, h * h - (even + odd) * (even - odd)));
    const double middle = 0.5 * (from + to);
    const double slope = even * std::sinh(middle) + odd * std::cosh(middle) < 0 ? -root : root;
    const bool adds = (slope > 0) == (h > 0);
    const double w = adds ? (h + slope) / (even + odd) : (even - odd) / (h - slope);
    if (!(w > 0) || !std::isfinite(w)) return nearer_end(c, from, to, z_mm);
    return clamped(std::log(w), from, to);
}
double solve_height(const BSplineCurve& c, double from, double to, double z_mm) {
    return parameter_at_height(c, from, to, z_mm);
}

}  // namespace

Point3 evaluate(const Curve& curve, double t) {
    return std::visit([&](const auto& c) { return point_at(c, t); }, curve);
}

Vector3 derivative(const Curve& curve, double t) {
    return std::visit([&](const auto& c) { return tangent_at(c, t); }, curve);
}

PointAndTangent point_and_tangent(const Curve& curve, double t) {
    if (const auto* spline = std::get_if<BSplineCurve>(&curve))
        return point_and_tangent(*spline, t);
    return {evaluate(curve, t), derivative(curve, t)};
}

double invert(const Curve& curve, const Point3& point) {
    return std::visit([&](const auto& c) { return parameter_of(c, point); }, curve);
}

double period(const Curve& curve) {
    if (std::holds_alternative<Circle>(curve) || std::holds_alternative<Ellipse>(curve))
        return 2 * pi;
    if (const auto* spline = std::get_if<BSplineCurve>(&curve);
        spline != nullptr && spline->closed) {
        return spline->domain_end() - spline->domain_start();
    }
    return 0;
}

std::vector<double> height_extrema(const Curve& curve, double from, double to) {
    return std::visit([&](const auto& c) { return extrema(c, from, to); }, curve);
}

double parameter_at_height(const Curve& curve, double from, double to, double z_mm) {
    return std::visit([&](const auto& c) { return solve_height(c, from, to, z_mm); }, curve);
}

Curve transformed(const Curve& curve, const Eigen::Affine3d& transform) {
    const double scale = std::cbrt(std::abs(transform.linear().determinant()));
    return std::visit(
        [&](auto c) -> Curve {
            using T = decltype(c);
            if constexpr (std::is_same_v<T, Line>) {
                return Line{transform * c.origin, (transform.linear() * c.direction).normalized()};
            } else if constexpr (std::is_same_v<T, BSplineCurve>) {
                for (Point3& p : c.control_points) p = transform * p;
                return c;
            } else {
                c.frame = transformed(c.frame, transform);
                if constexpr (std::is_same_v<T, Circle>) {
                    c.radius_mm *= scale;
                } else if constexpr (std::is_same_v<T, Parabola>) {
                    c.focal_mm *= scale;
                } else {
                    c.semi_x_mm *= scale;
                    c.semi_y_mm *= scale;
                }
                return c;
            }
        },
        curve);
}

}  // namespace lyr
