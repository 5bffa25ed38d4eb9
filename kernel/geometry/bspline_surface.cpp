// B-spline surfaces by basis functions: those that do not vanish at a parameter, with their derivatives, are found by
// Cox' and de Boor's recurrence in fixed rows, then control points are summed, in homogeneous coordinates when
// rational.

#include "kernel/geometry/bspline_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/geometry/bspline_axis.h"
#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

using Homogeneous = Eigen::Vector4d;
using Row = std::array<double, highest_surface_degree + 1>;

double into_domain(const Axis& axis, double t) {
    const double start = axis.start(), end = axis.end();
    if (t >= start && t <= end) return t;
    if (!axis.closed) return std::clamp(t, start, end);
    const double length = end - start;
    return std::clamp(t - std::floor((t - start) / length) * length, start, end);
}

// The span [knots[k], knots[k + 1]) that holds t, never an empty one; the one that ends at the knot `last`, if t is
// there.
std::size_t span_of(const Axis& axis, double t, double last) {
    const auto first = axis.knots.begin() + axis.degree;
    const auto end = axis.knots.begin() + static_cast<std::ptrdiff_t>(axis.count);
    const auto above = std::upper_bound(first, std::lower_bound(first, end, last), t);
    return static_cast<std::size_t>(std::max(above - 1, first) - axis.knots.begin());
}

// The degree + 1 basis functions that do not vanish on a span; `first` is the index of the first of them.
struct Basis {
    std::size_t first;
    double span_width;
    Row value, slope, bend;
};

// From the basis functions of one degree less (or their derivatives) to the derivatives of those of `degree`.
// `knots` points at the span's start.
void differentiate(const double* knots, int degree, const Row& lower, Row& out) {
    double before = 0;
    for (int r = 0; r < degree; ++r) {
        const auto i = static_cast<std::size_t>(r);
        const double term = lower[i] / (knots[r + 1] - knots[r + 1 - degree]);
        out[i] = degree * (before - term);
        before = term;
    }
    out[static_cast<std::size_t>(degree)] = degree * before;
}

void raise(const double* knots, int degree, double t, Row& row) {
    double saved = 0;
    for (int r = 0; r < degree; ++r) {
        const auto i = static_cast<std::size_t>(r);
        const double low = knots[r + 1 - degree], high = knots[r + 1];
        const double term = row[i] / (high - low);
        row[i] = saved + (high - t) * term;
        saved = (t - low) * term;
    }
    row[static_cast<std::size_t>(degree)] = saved;
}

// With the first `derivatives` derivatives.
template <int derivatives>
Basis basis_at(const Axis& axis, double t, double last) {
    const std::size_t span = span_of(axis, t, last);
    const double* const knots = axis.knots.data() + span;
    Basis basis;
    basis.first = span - static_cast<std::size_t>(axis.degree);
    basis.span_width = knots[1] - knots[0];
    basis.value[0] = 1;
    basis.slope[0] = basis.slope[1] = 0;
    basis.bend[0] = basis.bend[1] = 0;
    for (int degree = 1; degree <= axis.degree; ++degree) {
        if (derivatives > 1 && degree == axis.degree && degree > 1) {
            differentiate(knots, degree, basis.slope, basis.bend);
        }
        if (derivatives > 0 && degree + derivatives > axis.degree) {
            differentiate(knots, degree, basis.value, basis.slope);
        }
        raise(knots, degree, t, basis.value);
    }
    return basis;
}
template <int derivatives>
Basis basis_at(const Axis& axis, double t) {
    return basis_at<derivatives>(axis, into_domain(axis, t), axis.end());
}

template <class Value>
struct Sums {
    Value value = Value::Zero(), du = Value::Zero(), dv = Value::Zero();
    Value duu = Value::Zero(), duv = Value::Zero(), dvv = Value::Zero();
};

template <int derivatives, class Value, class Control>
Sums<Value> sum(const BSplineSurface& s, const Basis& u, const Basis& v, const Control& control) {
    Sums<Value> sums;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(s.degree_u); ++i) {
        const std::size_t line = (u.first + i) * s.count_v + v.first;
        Value value = Value::Zero(), slope = Value::Zero(), bend = Value::Zero();
        for (std::size_t j = 0; j <= static_cast<std::size_t>(s.degree_v); ++j) {
            const Value c = control(line + j);
            value += v.value[j] * c;
            if constexpr (derivatives > 0) slope += v.slope[j] * c;
            if constexpr (derivatives > 1) bend += v.bend[j] * c;
        }
        sums.value += u.value[i] * value;
        if constexpr (derivatives > 0) {
            sums.du += u.slope[i] * value;
            sums.dv += u.value[i] * slope;
        }
        if constexpr (derivatives > 1) {
            sums.duu += u.bend[i] * value;
            sums.duv += u.slope[i] * slope;
            sums.dvv += u.value[i] * bend;
        }
    }
    return sums;
}

// The quotient rule, for derivatives of a point given in homogeneous coordinates.
SurfaceJet projected(const Sums<Homogeneous>& h) {
    const double w = h.value.w();
    SurfaceJet jet;
    jet.point = h.value.head<3>() / w;
    jet.du = (h.du.head<3>() - h.du.w() * jet.point) / w;
    jet.dv = (h.dv.head<3>() - h.dv.w() * jet.point) / w;
    jet.duu = (h.duu.head<3>() - 2 * h.du.w() * jet.du - h.duu.w() * jet.point) / w;
    jet.duv = (h.duv.head<3>() - h.du.w() * jet.dv - h.dv.w() * jet.du - h.duv.w() * jet.point) / w;
    jet.dvv = (h.dvv.head<3>() - 2 * h.dv.w() * jet.dv - h.dvv.w() * jet.point) / w;
    return jet;
}

template <int derivatives>
SurfaceJet jet_of(const BSplineSurface& s, const Basis& u, const Basis& v) {
    if (s.weights.empty()) {
        const auto sums = sum<derivatives, Vector3>(
            s, u, v, [&](std::size_t i) -> const Point3& { return s.control_points[i]; });
        return {sums.value, sums.du, sums.dv, sums.duu, sums.duv, sums.dvv};
    }
    return projected(sum<derivatives, Homogeneous>(s, u, v, [&](std::size_t i) -> Homogeneous {
        const double w = s.weights[i];
        return (Homogeneous() << w * s.control_points[i], w).finished();
    }));
}

template <int derivatives>
SurfaceJet jet_at(const BSplineSurface& s, const Point2& uv) {
    return jet_of<derivatives>(s, basis_at<derivatives>(axis_u(s), uv.x()),
                               basis_at<derivatives>(axis_v(s), uv.y()));
}

// The largest coordinate among the control points that a basis refers to: what round-off is a share of.
double magnitude(const BSplineSurface& s, const Basis& u, const Basis& v) {
    double largest = 0;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(s.degree_u); ++i) {
        for (std::size_t j = 0; j <= static_cast<std::size_t>(s.degree_v); ++j) {
            const Point3& p = s.control_points[(u.first + i) * s.count_v + v.first + j];
            largest = std::max(largest, p.lpNorm<Eigen::Infinity>());
        }
    }
    return largest;
}

// d/du x d/dv, or where these vanish or are parallel the first term of it that does not on the way into the domain.
Vector3 normal_direction(const BSplineSurface& s, const Point2& uv) {
    const Axis u = axis_u(s), v = axis_v(s);
    const Point2 at(into_domain(u, uv.x()), into_domain(v, uv.y()));
    const Basis basis_u = basis_at<2>(u, at.x()), basis_v = basis_at<2>(v, at.y());
    const SurfaceJet jet = jet_of<2>(s, basis_u, basis_v);
    const Vector3 direct = jet.du.cross(jet.dv);
    // The square root of the spacing of doubles: direct is off by as much as the limit then.
    constexpr double negligible = 1e-8;
    const double scale =
        std::max(jet.du.norm() / basis_v.span_width, jet.dv.norm() / basis_u.span_width);
    const double smallest = negligible * magnitude(s, basis_u, basis_v) * scale;
    if (direct.norm() > smallest) return direct;
    const Vector2 inward =
        Point2((u.start() + u.end()) / 2 - at.x(), (v.start() + v.end()) / 2 - at.y())
            .cwiseProduct(Vector2(1 / (u.end() - u.start()), 1 / (v.end() - v.start())));
    const Vector2 step(inward.x() * basis_u.span_width, inward.y() * basis_v.span_width);
    const Vector3 du_change = step.x() * jet.duu + step.y() * jet.duv;
    const Vector3 dv_change = step.x() * jet.duv + step.y() * jet.dvv;
    const Vector3 limit = du_change.cross(jet.dv) + jet.du.cross(dv_change);
    if (limit.norm() > smallest) return limit;
    // Flatter than that: a normal from farther inside, for want of a better one.
    for (double share = 1e-4; share < 1; share *= 10) {
        const SurfaceJet inside = jet_at<1>(s, at + share * step);
        const Vector3 there = inside.du.cross(inside.dv);
        if (there.norm() > smallest) return there;
    }
    return direct;
}

}  // namespace

Point2 into_domain(const BSplineSurface& surface, const Point2& uv) {
    return {into_domain(axis_u(surface), uv.x()), into_domain(axis_v(surface), uv.y())};
}

Point3 evaluate(const BSplineSurface& surface, const Point2& uv) {
    return jet_at<0>(surface, uv).point;
}

Partials partials(const BSplineSurface& surface, const Point2& uv) {
    const SurfaceJet jet = jet_at<1>(surface, uv);
    return {jet.point, jet.du, jet.dv};
}

SurfaceJet second_partials(const BSplineSurface& s, const Point2& uv, const Window& window) {
    return jet_of<2>(s, basis_at<2>(axis_u(s), uv.x(), window.high.x()),
                     basis_at<2>(axis_v(s), uv.y(), window.high.y()));
}

Window smooth_window(const BSplineSurface& surface, const Point2& uv) {
    Window window;
    for (const int i : {0, 1}) {
        const Axis axis = i == 0 ? axis_u(surface) : axis_v(surface);
        const auto degree = static_cast<std::size_t>(axis.degree);
        // The last of `degree` equal knots, or the first of them.
        const auto ends_kink = [&](std::size_t k) {
            return axis.knots[k + 1 - degree] == axis.knots[k];
        };
        const auto begins_kink = [&](std::size_t k) {
            return axis.knots[k + degree - 1] == axis.knots[k];
        };
        std::size_t low = span_of(axis, uv[i], axis.end()), high = low + 1;
        while (low > degree && !ends_kink(low)) --low;
        while (high < axis.count && !begins_kink(high)) ++high;
        window.low[i] = axis.knots[low];
        window.high[i] = axis.knots[high];
    }
    return window;
}

Vector3 normal(const BSplineSurface& surface, const Point2& uv) {
    const Vector3 direction = normal_direction(surface, uv).normalized();
    return surface.mirrored ? Vector3(-direction) : direction;
}

BSplineSurface transformed(BSplineSurface surface, const Eigen::Affine3d& transform) {
    for (Point3& p : surface.control_points) p = transform * p;
    if (transform.linear().determinant() < 0) surface.mirrored = !surface.mirrored;
    return surface;
}

std::optional<Plane> as_plane(const BSplineSurface& surface) {
    Point3 centre = Point3::Zero();
    for (const Point3& p : surface.control_points) centre += p;
    centre /= static_cast<double>(surface.control_points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Point3& p : surface.control_points) {
        spread += (p - centre) * (p - centre).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    Frame frame{centre, axes.eigenvectors().col(2), axes.eigenvectors().col(1),
                axes.eigenvectors().col(0)};
    double thickness_mm = 0, width_mm = 0;
    for (const Point3& p : surface.control_points) {
        const Point3 local = frame.to_local(p);
        thickness_mm = std::max(thickness_mm, std::abs(local.z()));
        width_mm = std::max(width_mm, std::abs(local.y()));
    }
    if (thickness_mm > resolution_mm || width_mm <= resolution_mm) return std::nullopt;
    const Point2 middle((surface.start_u() + surface.end_u()) / 2,
                        (surface.start_v() + surface.end_v()) / 2);
    if (normal(surface, middle).dot(frame.z) < 0) frame.z = -frame.z;
    frame.y = frame.z.cross(frame.x);
    return Plane{frame};
}

}  // namespace lyr
