// Curves as B-splines, and the surfaces that they sweep out, all exact: conics by quadratic pieces with weights, a full
// turn by four quarters, parts of a B-spline by inserting knots at their ends.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_surface.h"

namespace lyr {

namespace {

using std::numbers::pi;
using Homogeneous = Eigen::Vector4d;

// Quadratic pieces, all equally wide: `corner(a, b)` gives the control point and the weight between the ends a and b,
// and for a = b the point there.
template <class Corner>
BSplineCurve quadratic(double from, double to, int pieces, const Corner& corner) {
    BSplineCurve result{2, {from, from, from}, {}, {}, false};
    const auto add = [&](const std::pair<Point3, double>& c) {
        result.control_points.push_back(c.first);
        result.weights.push_back(c.second);
    };
    add(corner(from, from));
    double a = from;
    for (int i = 1; i <= pieces; ++i) {
        const double b = i == pieces ? to : from + (to - from) * i / pieces;
        add(corner(a, b));
        add(corner(b, b));
        result.knots.insert(result.knots.end(), 2, b);
        a = b;
    }
    result.knots.push_back(to);
    return result;
}

BSplineCurve elliptic(const Frame& frame, double semi_x_mm, double semi_y_mm, double from,
                      double to) {
    // No more than a right angle each, save for what the ends of a full turn are rounded by.
    constexpr double rounding = 1e-12;
    const int pieces =
        std::max(1, static_cast<int>(std::ceil((to - from) / (pi / 2) * (1 - rounding))));
    BSplineCurve result = quadratic(from, to, pieces, [&](double a, double b) {
        const double middle = 0.5 * (a + b), weight = std::cos(0.5 * (b - a));
        const Point3 point = frame.origin + semi_x_mm * std::cos(middle) / weight * frame.x +
                             semi_y_mm * std::sin(middle) / weight * frame.y;
        return std::pair(point, weight);
    });
    if (std::abs(to - from - 2 * pi) <= rounding) {
        result.control_points.back() = result.control_points.front();
        result.closed = true;
    }
    return result;
}

BSplineCurve spline(const Line& c, double from, double to) {
    return {1, {from, from, to, to}, {evaluate(c, from), evaluate(c, to)}, {}, false};
}
BSplineCurve spline(const Circle& c, double from, double to) {
    return elliptic(c.frame, c.radius_mm, c.radius_mm, from, to);
}
BSplineCurve spline(const Ellipse& c, double from, double to) {
    return elliptic(c.frame, c.semi_x_mm, c.semi_y_mm, from, to);
}
BSplineCurve spline(const Parabola& c, double from, double to) {
    BSplineCurve result = quadratic(from, to, 1, [&](double a, double b) {
        const Point3 point =
            c.frame.origin + c.focal_mm * (a * b * c.frame.x + (a + b) * c.frame.y);
        return std::pair(point, 1.0);
    });
    result.weights.clear();
    return result;
}
BSplineCurve spline(const Hyperbola& c, double from, double to) {
    // Weights are cosh of half the width: at most 1.6.
    constexpr double widest = 2;
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / widest)));
    return quadratic(from, to, pieces, [&](double a, double b) {
        const double middle = 0.5 * (a + b), weight = std::cosh(0.5 * (b - a));
        const Point3 point = c.frame.origin + c.semi_x_mm * std::cosh(middle) / weight * c.frame.x +
                             c.semi_y_mm * std::sinh(middle) / weight * c.frame.y;
        return std::pair(point, weight);
    });
}

std::vector<Homogeneous> homogeneous(const BSplineCurve& c) {
    std::vector<Homogeneous> points;
    for (std::size_t i = 0; i < c.control_points.size(); ++i) {
        const double w = c.weights.empty() ? 1 : c.weights[i];
        points.emplace_back((Homogeneous() << w * c.control_points[i], w).finished());
    }
    return points;
}

// Boehm's algorithm, until the knot at t is there `degree` times: a control point then lies on the curve at t.
void insert_knot(BSplineCurve& c, double t) {
    const auto degree = static_cast<std::size_t>(c.degree);
    const auto range = std::equal_range(c.knots.begin(), c.knots.end(), t);
    for (auto there = static_cast<std::size_t>(range.second - range.first); there < degree;
         ++there) {
        const auto above = std::upper_bound(c.knots.begin(), c.knots.end(), t);
        const auto span = static_cast<std::size_t>(above - c.knots.begin()) - 1;
        const std::vector<Homogeneous> before = homogeneous(c);
        std::vector<Homogeneous> after(before);
        after.insert(after.begin() + static_cast<std::ptrdiff_t>(span - there),
                     before[span - there]);
        for (std::size_t i = span - degree + 1; i + there <= span; ++i) {
            const double share = (t - c.knots[i]) / (c.knots[i + degree] - c.knots[i]);
            after[i] = (1 - share) * before[i - 1] + share * before[i];
        }
        c.knots.insert(above, t);
        c.control_points.resize(after.size());
        for (std::size_t i = 0; i < after.size(); ++i) {
            c.control_points[i] = after[i].head<3>() / after[i].w();
        }
        if (c.weights.empty()) continue;
        c.weights.resize(after.size());
        for (std::size_t i = 0; i < after.size(); ++i) c.weights[i] = after[i].w();
    }
}

// Between two parameters of the domain, with its ends clamped.
BSplineCurve part(BSplineCurve c, double from, double to) {
    if (from == c.knots.front() && to == c.knots.back()) return c;
    insert_knot(c, from);
    insert_knot(c, to);
    const auto degree = static_cast<std::ptrdiff_t>(c.degree);
    const auto first = std::upper_bound(c.knots.begin(), c.knots.end(), from);
    const auto last = std::lower_bound(c.knots.begin(), c.knots.end(), to);
    BSplineCurve result{c.degree, {}, {}, {}, false};
    result.knots.assign(static_cast<std::size_t>(degree) + 1, from);
    result.knots.insert(result.knots.end(), first, last);
    result.knots.insert(result.knots.end(), static_cast<std::size_t>(degree) + 1, to);
    const auto begin = (first - c.knots.begin()) - degree - 1;
    const auto count = static_cast<std::ptrdiff_t>(result.knots.size()) - degree - 1;
    const auto points = c.control_points.begin() + begin;
    result.control_points.assign(points, points + count);
    if (!c.weights.empty()) {
        result.weights.assign(c.weights.begin() + begin, c.weights.begin() + begin + count);
    }
    return result;
}

BSplineCurve spline(const BSplineCurve& c, double from, double to) {
    const double start = c.domain_start(), end = c.domain_end(), length = end - start;
    if (!c.closed) return part(c, std::max(from, start), std::min(to, end));
    // Parameters this close to the seam, as a share of the curve, are on it.
    constexpr double rounding = 1e-12;
    const double turn = std::floor((from - start) / length + rounding) * length;
    const double low = std::max(from - turn, start), high = to - turn;
    const auto shifted = [&](BSplineCurve piece, double by) {
        for (double& knot : piece.knots) knot += by;
        return piece;
    };
    if (high <= end + rounding * length) {
        BSplineCurve piece = shifted(part(c, low, std::min(high, end)), turn);
        piece.closed = low == start && high >= end;
        return piece;
    }
    return joined(shifted(part(c, low, end), turn),
                  shifted(part(c, start, std::min(high - length, end)), turn + length));
}

}  // namespace

BSplineCurve rational(const Curve& curve, double from, double to) {
    return std::visit([&](const auto& c) { return spline(c, from, to); }, curve);
}

BSplineSurface extruded(const BSplineCurve& curve, const Vector3& sweep) {
    BSplineSurface s{curve.degree, 1, curve.control_points.size(), 2, curve.knots, {0, 0, 1, 1},
                     {},           {}};
    for (std::size_t i = 0; i < s.count_u; ++i) {
        s.control_points.push_back(curve.control_points[i]);
        s.control_points.push_back(curve.control_points[i] + sweep);
        if (!curve.weights.empty()) s.weights.insert(s.weights.end(), 2, curve.weights[i]);
    }
    s.closed_u = curve.closed;
    return s;
}

BSplineSurface revolved(const BSplineCurve& curve, const Frame& axis) {
    // Eighths of a turn, every other one on the corner of the square about the circle.
    constexpr std::array<double, 9> cosine{1, 1, 0, -1, -1, -1, 0, 1, 1};
    constexpr std::array<double, 9> sine{0, 1, 1, 1, 0, -1, -1, -1, 0};
    const double quarter = pi / 2;
    BSplineSurface s{
        2,
        curve.degree,
        9,
        curve.control_points.size(),
        {0, 0, 0, quarter, quarter, pi, pi, 3 * quarter, 3 * quarter, 2 * pi, 2 * pi, 2 * pi},
        curve.knots,
        {},
        {}};
    for (std::size_t i = 0; i < s.count_u; ++i) {
        const double weight = i % 2 == 0 ? 1 : std::sqrt(0.5);
        for (std::size_t j = 0; j < s.count_v; ++j) {
            const Point3 p = axis.to_local(curve.control_points[j]);
            s.control_points.push_back(axis.to_global(
                {cosine[i] * p.x() - sine[i] * p.y(), cosine[i] * p.y() + sine[i] * p.x(), p.z()}));
            s.weights.push_back(weight * (curve.weights.empty() ? 1 : curve.weights[j]));
        }
    }
    s.closed_u = true;
    s.closed_v = curve.closed;
    return s;
}

}  // namespace lyr
