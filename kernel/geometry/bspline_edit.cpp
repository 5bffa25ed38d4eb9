// B-spline curves turned around, raised in degree, put one behind the other.

#include <algorithm>

#include "kernel/geometry/bspline_curve.h"

namespace lyr {

namespace {

using Homogeneous = Eigen::Vector4d;

std::vector<Homogeneous> elevated(std::vector<Homogeneous> points, std::size_t degree) {
    while (points.size() <= degree) {
        const std::size_t count = points.size();
        std::vector<Homogeneous> raised(count + 1);
        raised.front() = points.front();
        raised.back() = points.back();
        for (std::size_t i = 1; i < count; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(count);
            raised[i] = share * points[i - 1] + (1 - share) * points[i];
        }
        points = std::move(raised);
    }
    return points;
}

}  // namespace

BSplineCurve reversed(BSplineCurve curve) {
    const double sum = curve.domain_start() + curve.domain_end();
    std::reverse(curve.knots.begin(), curve.knots.end());
    for (double& knot : curve.knots) knot = sum - knot;
    std::reverse(curve.control_points.begin(), curve.control_points.end());
    std::reverse(curve.weights.begin(), curve.weights.end());
    return curve;
}

BSplineCurve elevated(const BSplineCurve& curve, int degree) {
    if (degree <= curve.degree) return curve;
    const auto multiplicity = static_cast<std::size_t>(degree);
    BSplineCurve result{degree, {curve.domain_start()}, {}, {}, curve.closed};
    for (const BezierPiece& piece :
         bezier_pieces(curve, curve.domain_start(), curve.domain_end())) {
        const std::vector<Homogeneous> points = elevated(piece.control_points, multiplicity);
        for (std::size_t i = result.control_points.empty() ? 0 : 1; i < points.size(); ++i) {
            result.control_points.emplace_back(points[i].head<3>() / points[i].w());
            if (!curve.weights.empty()) result.weights.push_back(points[i].w());
        }
        result.knots.insert(result.knots.end(), multiplicity, piece.from);
    }
    result.knots.insert(result.knots.end(), multiplicity + 1, curve.domain_end());
    return result;
}

BSplineCurve joined(BSplineCurve first, BSplineCurve second) {
    const double shift = first.domain_end() - second.domain_start();
    for (double& knot : second.knots) knot += shift;
    first.knots.pop_back();
    first.knots.insert(first.knots.end(), second.knots.begin() + second.degree + 1,
                       second.knots.end());
    if (!first.weights.empty() || !second.weights.empty()) {
        first.weights.resize(first.control_points.size(), 1.0);
        second.weights.resize(second.control_points.size(), 1.0);
        const double share = first.weights.back() / second.weights.front();
        for (std::size_t i = 1; i < second.weights.size(); ++i) {
            first.weights.push_back(share * second.weights[i]);
        }
    }
    first.control_points.insert(first.control_points.end(), second.control_points.begin() + 1,
                                second.control_points.end());
    first.closed = false;
    return first;
}

}  // namespace lyr
