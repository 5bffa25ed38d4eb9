// The Bezier patches of a B-spline surface: along each parameter, a matrix for each knot span takes the control points
// that act there to those of the piece.

#include <algorithm>

#include "kernel/geometry/bspline_axis.h"
#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/bspline_surface.h"

namespace lyr {

namespace {

using Homogeneous = Eigen::Vector4d;

// Rows of the matrix that takes the control points of a span to those of its Bezier piece: row i is the blossom
// of the unit vectors at `degree - i` times the span's start and i times its end.
std::vector<double> bezier_matrix(const Axis& axis, std::size_t span) {
    const auto order = static_cast<std::size_t>(axis.degree) + 1;
    const double* const knots = axis.knots.data() + span;
    std::vector<double> matrix(order * order, 0.0), triangle(order * order);
    for (std::size_t i = 0; i < order; ++i) {
        std::fill(triangle.begin(), triangle.end(), 0.0);
        for (std::size_t k = 0; k < order; ++k) triangle[k * order + k] = 1;
        for (std::size_t level = 1; level < order; ++level) {
            const double t = level <= i ? knots[1] : knots[0];
            for (std::size_t k = order - 1; k >= level; --k) {
                const double low = *(knots + k + 1 - order);
                const double high = *(knots + k + 1 - level);
                const double alpha = (t - low) / (high - low);
                for (std::size_t c = 0; c < order; ++c) {
                    triangle[k * order + c] = (1 - alpha) * triangle[(k - 1) * order + c] +
                                              alpha * triangle[k * order + c];
                }
            }
        }
        std::copy(triangle.end() - static_cast<std::ptrdiff_t>(order), triangle.end(),
                  matrix.begin() + static_cast<std::ptrdiff_t>(i * order));
    }
    return matrix;
}

struct Span {
    std::size_t index;
    std::vector<double> matrix;
    bool joined = false;  // to the one before, which a knot of full multiplicity would prevent

    Span(const Axis& axis, std::size_t k) : index(k), matrix(bezier_matrix(axis, k)) {}
};

std::vector<Span> spans_of(const Axis& axis) {
    std::vector<Span> spans;
    for (auto k = static_cast<std::size_t>(axis.degree); k < axis.count; ++k) {
        if (!(axis.knots[k] < axis.knots[k + 1])) continue;
        const bool joined =
            !spans.empty() && k - spans.back().index <= static_cast<std::size_t>(axis.degree);
        spans.emplace_back(axis, k).joined = joined;
    }
    return spans;
}

std::vector<Homogeneous> patch_points(const BSplineSurface& s, const Span& u, const Span& v) {
    const auto order_u = static_cast<std::size_t>(s.degree_u) + 1;
    const auto order_v = static_cast<std::size_t>(s.degree_v) + 1;
    std::vector<Homogeneous> half(order_u * order_v, Homogeneous::Zero());
    std::vector<Homogeneous> points(order_u * order_v, Homogeneous::Zero());
    for (std::size_t k = 0; k < order_u; ++k) {
        for (std::size_t l = 0; l < order_v; ++l) {
            const std::size_t at =
                (u.index + 1 - order_u + k) * s.count_v + v.index + 1 - order_v + l;
            const double w = s.weights.empty() ? 1 : s.weights[at];
            const Homogeneous c = (Homogeneous() << w * s.control_points[at], w).finished();
            for (std::size_t j = 0; j < order_v; ++j) {
                half[k * order_v + j] += v.matrix[j * order_v + l] * c;
            }
        }
    }
    for (std::size_t i = 0; i < order_u; ++i) {
        for (std::size_t k = 0; k < order_u; ++k) {
            const double share = u.matrix[i * order_u + k];
            for (std::size_t j = 0; j < order_v; ++j) {
                points[i * order_v + j] += share * half[k * order_v + j];
            }
        }
    }
    if (s.weights.empty()) {
        for (Homogeneous& p : points) p.w() = 1;
    }
    return points;
}

BezierPatch patch_of(const BSplineSurface& s, const Span& u, const Span& v) {
    return {s.knots_u[u.index],   s.knots_u[u.index + 1],
            s.knots_v[v.index],   s.knots_v[v.index + 1],
            s.degree_u,           s.degree_v,
            patch_points(s, u, v)};
}

}  // namespace

BezierPatch bezier_patch(const BSplineSurface& s, std::size_t span_u, std::size_t span_v) {
    return patch_of(s, Span(axis_u(s), span_u), Span(axis_v(s), span_v));
}

BezierPatches bezier_patches(const BSplineSurface& s) {
    const std::vector<Span> spans_u = spans_of(axis_u(s)), spans_v = spans_of(axis_v(s));
    const auto order_u = static_cast<std::size_t>(s.degree_u) + 1;
    const auto order_v = static_cast<std::size_t>(s.degree_v) + 1;
    BezierPatches result{spans_u.size(), spans_v.size(), {}};
    result.patches.reserve(spans_u.size() * spans_v.size());
    for (std::size_t a = 0; a < spans_u.size(); ++a) {
        for (std::size_t b = 0; b < spans_v.size(); ++b) {
            BezierPatch patch = patch_of(s, spans_u[a], spans_v[b]);
            auto& points = patch.control_points;
            if (spans_u[a].joined) {
                const auto& before = result.patches[(a - 1) * spans_v.size() + b].control_points;
                std::copy_n(before.end() - static_cast<std::ptrdiff_t>(order_v), order_v,
                            points.begin());
            }
            if (spans_v[b].joined) {
                const auto& before = result.patches.back().control_points;
                for (std::size_t i = 0; i < order_u; ++i) {
                    points[i * order_v] = before[i * order_v + order_v - 1];
                }
            }
            result.patches.push_back(std::move(patch));
        }
    }
    return result;
}

}  // namespace lyr
