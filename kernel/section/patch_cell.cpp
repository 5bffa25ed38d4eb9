// The direction of the normal is a polynomial N whose values lie in the cone of its coefficients. With a the mean of
// those in the corners and N.a > 0 on the cell, |n_z| = |N_z / N.a| cos(N, a): the quotient is bounded by those of the
// coefficients, the cosine by 1 and by the coefficients' least. What is lost is of second order in the cell's size.

#include <algorithm>
#include <cmath>

#include "kernel/geometry/offset_patch.h"
#include "kernel/section/parameter_cell.h"

namespace lyr {
namespace {

using bernstein::Tensor;

// Where normals may point anywhere.
constexpr double unknown = 2;

// How much neighbouring coefficients differ in sum, along u and along v.
Vector2 variation(const Tensor& a) {
    Vector2 sum = Vector2::Zero();
    for (std::size_t i = 0; i <= a.degree_u; ++i) {
        for (std::size_t j = 0; j <= a.degree_v; ++j) {
            if (i > 0) sum.x() += std::abs(a.at(i, j) - a.at(i - 1, j));
            if (j > 0) sum.y() += std::abs(a.at(i, j) - a.at(i, j - 1));
        }
    }
    // Of one line each, on average: the other parameter's degree may be higher.
    return {sum.x() / static_cast<double>(a.degree_v + 1),
            sum.y() / static_cast<double>(a.degree_u + 1)};
}

Vector3 coefficient(const bernstein::Tensor3& a, std::size_t k) {
    return {a[0].coefficients[k], a[1].coefficients[k], a[2].coefficients[k]};
}

}  // namespace

PatchCell::PatchCell(const BezierPatch& patch, bool is_rational)
    : rect_{{patch.from_u, patch.from_v}, {patch.to_u, patch.to_v}} {
    constexpr offset_patch::Stretch all{0, 0, 1};
    offset_patch::Piece piece =
        offset_patch::part(offset_patch::piece_of(patch, is_rational), all, all);
    origin_mm_ = piece.origin.z();
    normal_ = std::move(piece.normal);
    height_ = std::move(piece.point[2]);
    weight_ = std::move(piece.weight);
}

CellBounds PatchCell::bounds() const {
    const bool is_rational = weight_.coefficients.size() > 1;
    CellBounds result{.bottom_mm = 0, .top_mm = 0, .least = 0, .mean = 1, .most = unknown};
    for (std::size_t k = 0; k < height_.coefficients.size(); ++k) {
        const double weight = is_rational ? weight_.coefficients[k] : 1;
        const double z = origin_mm_ + height_.coefficients[k] / weight;
        result.bottom_mm = k > 0 ? std::min(result.bottom_mm, z) : z;
        result.top_mm = k > 0 ? std::max(result.top_mm, z) : z;
    }
    // Corners are coefficients.
    const std::size_t m = normal_[0].degree_u, n = normal_[0].degree_v;
    Vector3 sum = Vector3::Zero();
    double mean = 0;
    for (const std::size_t k : {std::size_t{0}, n, m * (n + 1), m * (n + 1) + n}) {
        const Vector3 corner = coefficient(normal_, k);
        if (!(corner.squaredNorm() > 0)) return result;
        sum += corner.normalized();
        mean += std::abs(corner.normalized().z()) / 4;
    }
    const Vector3 axis = sum.normalized();
    result.mean = mean;
    double low = 1, high = -1, cosine = 1;
    for (std::size_t k = 0; k < normal_[0].coefficients.size(); ++k) {
        const Vector3 normal = coefficient(normal_, k);
        const double along = normal.dot(axis);
        if (!(along > 0)) return result;
        const double share = normal.z() / along;
        low = k > 0 ? std::min(low, share) : share;
        high = k > 0 ? std::max(high, share) : share;
        cosine = std::min(cosine, along / normal.norm());
    }
    result.most = std::max(-low, high);
    result.least = std::min(mean, cosine * std::max({0.0, low, -high}));
    return result;
}

std::array<PatchCell, 2> PatchCell::halves(CellMeasure by) const {
    Vector2 varies = variation(height_);
    if (by == CellMeasure::flatness) {
        varies = variation(normal_[0]) + variation(normal_[1]) + variation(normal_[2]);
    }
    const Eigen::Index along = varies.y() > varies.x() ? 1 : 0;
    const auto half = [&](double from) {
        const auto part = [&](const Tensor& a) {
            return bernstein::part(a, static_cast<int>(along), from, from + 0.5);
        };
        PatchCell cell;
        cell.rect_ = rect_;
        (from == 0 ? cell.rect_.high : cell.rect_.low)[along] = rect_.middle()[along];
        cell.origin_mm_ = origin_mm_;
        for (std::size_t i = 0; i < 3; ++i) cell.normal_[i] = part(normal_[i]);
        cell.height_ = part(height_);
        cell.weight_ = weight_.coefficients.size() > 1 ? part(weight_) : weight_;
        return cell;
    };
    return {half(0), half(0.5)};
}

}  // namespace lyr
