// Squared distances as polynomials in Bernstein form, which bounds them.

#include "kernel/geometry/distance_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lyr {

namespace {

using Homogeneous = Eigen::Vector4d;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> binomials(std::size_t degree) {
    std::vector<double> row(degree + 1, 1.0);
    for (std::size_t i = 1; i < row.size(); ++i) {
        row[i] = row[i - 1] * static_cast<double>(degree - i + 1) / static_cast<double>(i);
    }
    return row;
}

// de Casteljau at the middle of rows of `count` points, `stride` apart; `right` holds the whole before.
void halve(std::vector<Homogeneous>& left, std::vector<Homogeneous>& right, std::size_t first,
           std::size_t count, std::size_t stride) {
    for (std::size_t level = count; level > 0; --level) {
        left[first + (count - level) * stride] = right[first];
        for (std::size_t i = 0; i + 1 < level; ++i) {
            Homogeneous& here = right[first + i * stride];
            here = 0.5 * (here + right[first + (i + 1) * stride]);
        }
    }
}

}  // namespace

Cell cell_about(BezierPatch patch, const Point3& point) {
    for (Homogeneous& c : patch.control_points) c.head<3>() -= c.w() * point;
    return {{{patch.from_u, patch.from_v}, {patch.to_u, patch.to_v}},
            std::move(patch.control_points)};
}

std::pair<Cell, Cell> halves(Cell cell, int degree_u, int degree_v, int along) {
    Cell left = cell;
    const auto order_u = static_cast<std::size_t>(degree_u) + 1;
    const auto order_v = static_cast<std::size_t>(degree_v) + 1;
    if (along == 0) {
        for (std::size_t j = 0; j < order_v; ++j)
            halve(left.points, cell.points, j, order_u, order_v);
    } else {
        for (std::size_t i = 0; i < order_u; ++i)
            halve(left.points, cell.points, i * order_v, order_v, 1);
    }
    const double middle = 0.5 * (cell.window.low[along] + cell.window.high[along]);
    left.window.high[along] = cell.window.low[along] = middle;
    return {std::move(left), std::move(cell)};
}

double box_distance_mm(const Cell& cell) {
    Eigen::AlignedBox3d box;
    for (const Homogeneous& c : cell.points) box.extend(Point3(c.head<3>() / c.w()));
    return box.exteriorDistance(Point3::Zero());
}

DistanceForm::DistanceForm(const Cell& cell, int degree_u, int degree_v)
    : size_u_(2 * static_cast<std::size_t>(degree_u) + 1),
      size_v_(2 * static_cast<std::size_t>(degree_v) + 1),
      numerator_(size_u_ * size_v_, 0.0),
      weight_(size_u_ * size_v_, 0.0) {
    const std::size_t order_u = size_u_ / 2 + 1, order_v = size_v_ / 2 + 1;
    // Scaled by binomials, coefficients multiply like those of ordinary polynomials.
    const std::vector<double> row_u = binomials(order_u - 1), row_v = binomials(order_v - 1);
    std::vector<Homogeneous> scaled(cell.points);
    for (std::size_t i = 0; i < order_u; ++i) {
        for (std::size_t j = 0; j < order_v; ++j) scaled[i * order_v + j] *= row_u[i] * row_v[j];
    }
    for (std::size_t i = 0; i < scaled.size(); ++i) {
        for (std::size_t k = 0; k < scaled.size(); ++k) {
            const std::size_t at =
                (i / order_v + k / order_v) * size_v_ + i % order_v + k % order_v;
            numerator_[at] += scaled[i].head<3>().dot(scaled[k].head<3>());
            weight_[at] += scaled[i].w() * scaled[k].w();
        }
    }
    const std::vector<double> rows = binomials(size_u_ - 1), columns = binomials(size_v_ - 1);
    for (std::size_t i = 0; i < size_u_; ++i) {
        for (std::size_t j = 0; j < size_v_; ++j) {
            numerator_[i * size_v_ + j] /= rows[i] * columns[j];
            weight_[i * size_v_ + j] /= rows[i] * columns[j];
        }
    }
}

double DistanceForm::lower_bound_mm() const {
    double bound = infinity;
    for (std::size_t i = 0; i < numerator_.size(); ++i) {
        bound = std::min(bound, numerator_[i] / weight_[i]);
    }
    return std::sqrt(std::max(bound, 0.0));
}

bool DistanceForm::is_convex() const {
    double least_uu = infinity, least_vv = infinity, most_uv = 0;
    const auto c = [&](std::size_t i, std::size_t j) { return numerator_[i * size_v_ + j]; };
    for (std::size_t i = 0; i < size_u_; ++i) {
        for (std::size_t j = 0; j < size_v_; ++j) {
            if (i > 1) {
                least_uu = std::min(least_uu, c(i, j) - 2 * c(i - 1, j) + c(i - 2, j));
            }
            if (j > 1) {
                least_vv = std::min(least_vv, c(i, j) - 2 * c(i, j - 1) + c(i, j - 2));
            }
            if (i > 0 && j > 0) {
                most_uv = std::max(most_uv,
                                   std::abs(c(i, j) - c(i - 1, j) - c(i, j - 1) + c(i - 1, j - 1)));
            }
        }
    }
    const auto m = static_cast<double>(size_u_ - 1), n = static_cast<double>(size_v_ - 1);
    return least_uu > 0 && least_vv > 0 &&
           (m - 1) * (n - 1) * least_uu * least_vv > m * n * most_uv * most_uv;
}

bool DistanceForm::varies_more_along_u() const {
    double along_u = 0, along_v = 0;
    for (std::size_t i = 0; i < size_u_; ++i) {
        for (std::size_t j = 0; j < size_v_; ++j) {
            const double here = numerator_[i * size_v_ + j];
            if (i > 0) {
                along_u = std::max(along_u, std::abs(here - numerator_[(i - 1) * size_v_ + j]));
            }
            if (j > 0) {
                along_v = std::max(along_v, std::abs(here - numerator_[i * size_v_ + j - 1]));
            }
        }
    }
    return along_u >= along_v;
}

}  // namespace lyr
