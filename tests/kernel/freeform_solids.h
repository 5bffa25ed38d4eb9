// Closed solids of B-spline faces with a known volume: a cube of control points, bent at random.

#pragma once

#include <array>
#include <random>

#include "kernel/geometry/bspline_surface.h"
#include "kernel/solids.h"

namespace lyr::testing {

// A Bezier volume of degree n in each of three parameters; rational if its weights are not all one.
class BezierVolume {
public:
    // A cube of edge `size` with every control point moved by up to `bend` of the distance between neighbours.
    BezierVolume(int degree, double size, double bend, bool rational, unsigned seed)
        : n_(degree), count_(static_cast<std::size_t>(degree + 1)) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> amount(-1, 1);
        const double step = size / degree;
        for (std::size_t i = 0; i < count_; ++i) {
            for (std::size_t j = 0; j < count_; ++j) {
                for (std::size_t k = 0; k < count_; ++k) {
                    const Point3 grid(static_cast<double>(i), static_cast<double>(j),
                                      static_cast<double>(k));
                    const Vector3 move(amount(random), amount(random), amount(random));
                    points_.push_back(step * (grid + bend * move) - Vector3::Constant(size / 2));
                    weights_.push_back(rational ? 1 + 0.4 * amount(random) : 1.0);
                }
            }
        }
    }

    std::size_t at(std::size_t i, std::size_t j, std::size_t k) const {
        return (i * count_ + j) * count_ + k;
    }
    int degree() const { return n_; }
    std::size_t count() const { return count_; }
    const Point3& point(std::size_t index) const { return points_[index]; }
    double weight(std::size_t index) const { return weights_[index]; }

    // By Gauss-Legendre quadrature of the Jacobian, enough points to make it exact for polynomials of these degrees.
    double volume_mm3() const;

private:
    int n_;
    std::size_t count_;
    std::vector<Point3> points_;
    std::vector<double> weights_;
};

inline double BezierVolume::volume_mm3() const {
    // Composite of five points: exact to degree nine on each of four panels.
    constexpr std::array<double, 5> gauss{0.04691007703066800, 0.23076534494715845, 0.5,
                                          0.76923465505284155, 0.95308992296933200};
    constexpr std::array<double, 5> weight{0.11846344252809454, 0.23931433524968324,
                                           0.28444444444444444, 0.23931433524968324,
                                           0.11846344252809454};
    constexpr int panels = 4;
    std::vector<double> nodes, shares;
    for (int p = 0; p < panels; ++p) {
        for (std::size_t g = 0; g < 5; ++g) {
            nodes.push_back((p + gauss[g]) / panels);
            shares.push_back(weight[g] / panels);
        }
    }
    const auto basis = [&](double t) {
        std::vector<double> b(count_), d(count_);
        double binomial = 1;
        for (std::size_t i = 0; i < count_; ++i) {
            const double a = static_cast<double>(i), m = static_cast<double>(n_) - a;
            b[i] = binomial * std::pow(t, a) * std::pow(1 - t, m);
            d[i] = b[i] * (a / t - m / (1 - t));
            binomial *= m / (a + 1);
        }
        return std::pair(b, d);
    };
    double volume = 0;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
        const auto [bu, du] = basis(nodes[a]);
        for (std::size_t b = 0; b < nodes.size(); ++b) {
            const auto [bv, dv] = basis(nodes[b]);
            for (std::size_t c = 0; c < nodes.size(); ++c) {
                const auto [bw, dw] = basis(nodes[c]);
                Eigen::Vector4d p = Eigen::Vector4d::Zero();
                std::array<Eigen::Vector4d, 3> d{p, p, p};
                for (std::size_t i = 0; i < count_; ++i) {
                    for (std::size_t j = 0; j < count_; ++j) {
                        for (std::size_t k = 0; k < count_; ++k) {
                            const std::size_t index = this->at(i, j, k);
                            Eigen::Vector4d control;
                            control << weights_[index] * points_[index], weights_[index];
                            p += bu[i] * bv[j] * bw[k] * control;
                            d[0] += du[i] * bv[j] * bw[k] * control;
                            d[1] += bu[i] * dv[j] * bw[k] * control;
                            d[2] += bu[i] * bv[j] * dw[k] * control;
                        }
                    }
                }
                Eigen::Matrix3d jacobian;
                for (int x = 0; x < 3; ++x) {
                    const auto& by = d[static_cast<std::size_t>(x)];
                    jacobian.col(x) = (by.head<3>() - by.w() * p.head<3>() / p.w()) / p.w();
                }
                volume += shares[a] * shares[b] * shares[c] * jacobian.determinant();
            }
        }
    }
    return volume;
}

// The volume's six sides as faces that share their edges.
inline Model bent_cube(const BezierVolume& volume) {
    Builder b;
    const std::size_t last = volume.count() - 1, n = volume.count();
    using Index = std::array<std::size_t, 3>;
    const auto control = [&](const Index& at) { return volume.at(at[0], at[1], at[2]); };
    const auto knots = [&] {
        std::vector<double> k(n, 0.0);
        k.resize(2 * n, 1.0);
        return k;
    }();
    VertexId v[2][2][2];
    for (std::size_t i : {0u, 1u}) {
        for (std::size_t j : {0u, 1u}) {
            for (std::size_t k : {0u, 1u}) {
                const Point3& p = volume.point(volume.at(i * last, j * last, k * last));
                v[i][j][k] = b.vertex(p.x(), p.y(), p.z());
            }
        }
    }
    // edge[axis][a][b]: along `axis`, the other two parameters (in order) at a and b.
    EdgeId edge[3][2][2];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
        for (std::size_t p : {0u, 1u}) {
            for (std::size_t q : {0u, 1u}) {
                BSplineCurve curve{volume.degree(), knots, {}, {}};
                Index at{};
                at[first] = p * last;
                at[second] = q * last;
                for (at[axis] = 0; at[axis] < n; ++at[axis]) {
                    curve.control_points.push_back(volume.point(control(at)));
                    curve.weights.push_back(volume.weight(control(at)));
                }
                Index from{}, to{};
                from[first] = to[first] = p;
                from[second] = to[second] = q;
                to[axis] = 1;
                edge[axis][p][q] =
                    b.edge(curve, v[from[0]][from[1]][from[2]], v[to[0]][to[1]][to[2]]);
            }
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t side : {0u, 1u}) {
            const std::size_t first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
            BSplineSurface s{volume.degree(), volume.degree(), n, n, knots, knots, {}, {}};
            Index at{};
            at[axis] = side * last;
            for (at[first] = 0; at[first] < n; ++at[first]) {
                for (at[second] = 0; at[second] < n; ++at[second]) {
                    s.control_points.push_back(volume.point(control(at)));
                    s.weights.push_back(volume.weight(control(at)));
                }
            }
            // first x second is +axis for axes 0 and 2, -axis for 1; outward on side 1.
            const bool outward = (side == 1) == (axis != 1);
            const auto along = [&](std::size_t direction, std::size_t other) {
                const std::size_t rest = direction == first ? second : first;
                // The fixed parameters in rising order of their axes.
                return axis < rest ? edge[direction][side][other] : edge[direction][other][side];
            };
            std::vector<Use> loop{{along(first, 0)},
                                  {along(second, 1)},
                                  {along(first, 1), true},
                                  {along(second, 0), true}};
            if (!outward) {
                std::reverse(loop.begin(), loop.end());
                for (Use& use : loop) use.reversed = !use.reversed;
            }
            b.face(std::make_shared<const BSplineSurface>(std::move(s)), outward, {loop});
        }
    }
    return b.finish();
}

}  // namespace lyr::testing
