// Each piece is halved until the remainder of the interpolation of degree 7 is bounded.

#include "kernel/geometry/curve_approximation.h"

#include <cmath>

#include "kernel/geometry/interpolation.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

double remainder_mm(const CurveFunction& f, double from, double to) {
    double sum = 0;
    for (const Series& c : f.series(Series::variable(from, to))) {
        sum += std::pow(c.coefficient(Series::order).magnitude(), 2);
    }
    return std::sqrt(sum) * std::pow(to - from, static_cast<double>(Series::order)) *
           interpolation::node_product(interpolation::degree);
}

class Approximation {
public:
    explicit Approximation(double allowed_mm) : allowed_mm_(allowed_mm) {}

    bool append(const CurveFunction& f, double from, double to, int depth) {
        // Of a piece: what is not bounded by then is not smooth.
        constexpr int most_halvings = 24;
        if (!(remainder_mm(f, from, to) <= allowed_mm_)) {
            if (depth == most_halvings) return false;
            const double middle = 0.5 * (from + to);
            return append(f, from, middle, depth + 1) && append(f, middle, to, depth + 1);
        }
        return append_interpolation(f, from, to);
    }

    BSplineCurve finished() {
        curve_.knots.push_back(curve_.knots.back());
        const Point3 gap = curve_.control_points.front() - curve_.control_points.back();
        curve_.closed = gap.norm() <= resolution_mm;
        return std::move(curve_);
    }

private:
    bool append_interpolation(const CurveFunction& f, double from, double to) {
        constexpr int n = interpolation::degree;
        Eigen::Matrix<double, n + 1, 3> values;
        for (int i = 0; i <= n; ++i) {
            const double share = nodes_[static_cast<std::size_t>(i)];
            const Triple<double> p = f.value(i == n ? to : from + share * (to - from));
            values.row(i) << p[0], p[1], p[2];
        }
        const Eigen::Matrix<double, n + 1, 3> control = bernstein_ * values;
        if (!control.allFinite()) return false;
        auto& points = curve_.control_points;
        if (points.empty()) {
            points.emplace_back(control.row(0));
            curve_.knots.assign(static_cast<std::size_t>(n) + 1, from);
        } else if ((points.back() - Point3(control.row(0))).norm() > resolution_mm) {
            return false;
        }
        for (int i = 1; i <= n; ++i) points.emplace_back(control.row(i));
        curve_.knots.insert(curve_.knots.end(), static_cast<std::size_t>(n), to);
        return true;
    }

    double allowed_mm_;
    BSplineCurve curve_{interpolation::degree, {}, {}, {}, false};
    std::vector<double> nodes_ = interpolation::nodes(interpolation::degree);
    Eigen::MatrixXd bernstein_ = interpolation::bernstein_from_values(interpolation::degree);
};

}  // namespace

std::optional<BSplineCurve> approximated(const std::vector<SmoothPiece>& pieces,
                                         double allowed_mm) {
    Approximation result(allowed_mm);
    for (const SmoothPiece& piece : pieces) {
        if (!result.append(piece.function, piece.from, piece.to, 0)) return std::nullopt;
    }
    return result.finished();
}

}  // namespace lyr
