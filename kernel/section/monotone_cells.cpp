// The height of a rational patch is Z / W, both polynomials. On the level h its derivative has the sign of
// Z' - h W', which is linear in h: it keeps one sign for every h of the cell's range if it does at both ends of it.

#include "kernel/section/monotone_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lyr {
namespace {

// Coefficients of Z and W on one cell, in rows of u; `w` is empty for a polynomial patch.
struct HeightPatch {
    int degree_u, degree_v;
    std::vector<double> z, w;
    double from_u, to_u, from_v, to_v;

    std::size_t at(int i, int j) const { return static_cast<std::size_t>(i * (degree_v + 1) + j); }
};

struct Range {
    double low, high;
};

Range height_range(const HeightPatch& patch) {
    Range range{patch.z[0] / (patch.w.empty() ? 1 : patch.w[0]), 0};
    range.high = range.low;
    for (std::size_t k = 1; k < patch.z.size(); ++k) {
        const double z = patch.w.empty() ? patch.z[k] : patch.z[k] / patch.w[k];
        range.low = std::min(range.low, z);
        range.high = std::max(range.high, z);
    }
    return range;
}

// Extremes of the differences of Z - h W along u or v; of their signs speaks the derivative's.
struct Slopes {
    double low = 0, high = 0;

    bool one_sign() const { return (low >= 0 && high > 0) || (high <= 0 && low < 0); }
    // A slope that stays within this factor keeps a graph's parameter regular.
    bool steady() const {
        constexpr double most_variation = 32;
        return low > 0 ? high <= most_variation * low : high < 0 && low >= most_variation * high;
    }
    double least() const { return std::min(std::abs(low), std::abs(high)); }
    double most() const { return std::max(std::abs(low), std::abs(high)); }
    void add(double difference, bool first) {
        low = first ? difference : std::min(low, difference);
        high = first ? difference : std::max(high, difference);
    }
};

Slopes slopes(const HeightPatch& patch, bool along_u, const Range& range) {
    Slopes result;
    bool first = true;
    const int last_i = patch.degree_u - (along_u ? 1 : 0);
    const int last_j = patch.degree_v - (along_u ? 0 : 1);
    for (int i = 0; i <= last_i; ++i) {
        for (int j = 0; j <= last_j; ++j) {
            const std::size_t a = patch.at(i, j),
                              b = along_u ? patch.at(i + 1, j) : patch.at(i, j + 1);
            const double dz = patch.z[b] - patch.z[a];
            if (patch.w.empty()) {
                result.add(dz, first);
            } else {
                const double dw = patch.w[b] - patch.w[a];
                result.add(dz - range.low * dw, first);
                result.add(dz - range.high * dw, false);
            }
            first = false;
        }
    }
    return result;
}

// The greatest second differences of the height along u and along v: which way to divide. Those in millimetres, not
// as shares of the slopes: where a slope is but round-off (a level circle), dividing along it leads nowhere.
struct Bending {
    double along_u = 0, along_v = 0;
};

Bending bending(const HeightPatch& patch) {
    Bending result;
    const auto z = [&](int i, int j) {
        const std::size_t k = patch.at(i, j);
        return patch.w.empty() ? patch.z[k] : patch.z[k] / patch.w[k];
    };
    for (int i = 0; i <= patch.degree_u; ++i) {
        for (int j = 0; j <= patch.degree_v; ++j) {
            if (i >= 2) {
                result.along_u =
                    std::max(result.along_u, std::abs(z(i, j) - 2 * z(i - 1, j) + z(i - 2, j)));
            }
            if (j >= 2) {
                result.along_v =
                    std::max(result.along_v, std::abs(z(i, j) - 2 * z(i, j - 1) + z(i, j - 2)));
            }
        }
    }
    return result;
}

// De Casteljau on one line of `count` coefficients: `left` and `right` may be the line itself.
void split_line(const double* line, std::size_t stride, int count, double t, double* left,
                double* right) {
    double work[highest_surface_degree + 1];
    for (int i = 0; i < count; ++i) work[i] = line[static_cast<std::size_t>(i) * stride];
    for (int level = count; level > 0; --level) {
        left[static_cast<std::size_t>(count - level) * stride] = work[0];
        right[static_cast<std::size_t>(level - 1) * stride] = work[level - 1];
        for (int i = 0; i + 1 < level; ++i) work[i] = (1 - t) * work[i] + t * work[i + 1];
    }
}

void split_coefficients(const HeightPatch& patch, const std::vector<double>& c, bool along_u,
                        double t, std::vector<double>& left, std::vector<double>& right) {
    left.resize(c.size());
    right.resize(c.size());
    if (c.empty()) return;
    const std::size_t stride = along_u ? static_cast<std::size_t>(patch.degree_v + 1) : 1;
    const int lines = along_u ? patch.degree_v + 1 : patch.degree_u + 1;
    const int count = along_u ? patch.degree_u + 1 : patch.degree_v + 1;
    for (int line = 0; line < lines; ++line) {
        const std::size_t first = along_u ? patch.at(0, line) : patch.at(line, 0);
        split_line(&c[first], stride, count, t, &left[first], &right[first]);
    }
}

using Row = std::array<double, highest_surface_degree + 1>;

double value_at(const Row& coefficients, int degree, double t) {
    Row c = coefficients;
    for (int level = degree; level > 0; --level) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(level); ++i) {
            c[i] = (1 - t) * c[i] + t * c[i + 1];
        }
    }
    return c[0];
}

// Coefficients, along one parameter at the middle of the other, of the height's derivative by the one or the other.
// For rational patches those of the control points' heights, which is good enough to aim at: the next division aims better.
Row middle_slope(const HeightPatch& patch, bool along_u, bool by_other, int& degree) {
    const int count = along_u ? patch.degree_u + 1 : patch.degree_v + 1;
    const int across = along_u ? patch.degree_v + 1 : patch.degree_u + 1;
    Row middle{}, line{};
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < across; ++k) {
            const std::size_t at = along_u ? patch.at(i, k) : patch.at(k, i);
            line[static_cast<std::size_t>(k)] =
                patch.w.empty() ? patch.z[at] : patch.z[at] / patch.w[at];
        }
        if (by_other) {
            for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(across); ++k) {
                line[k] = line[k + 1] - line[k];
            }
        }
        middle[static_cast<std::size_t>(i)] = value_at(line, across - (by_other ? 2 : 1), 0.5);
    }
    degree = by_other ? count - 1 : count - 2;
    if (by_other) return middle;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
        middle[i] = middle[i + 1] - middle[i];
    }
    return middle;
}

// Where one of the derivatives changes its sign along the patch's middle line, or else the middle.
double division(const HeightPatch& patch, bool along_u) {
    constexpr double nearest_border = 1.0 / 16;
    for (const bool by_other : {false, true}) {
        int degree = 0;
        const Row slope = middle_slope(patch, along_u, by_other, degree);
        if (degree < 1) continue;
        double low = nearest_border, high = 1 - nearest_border;
        const bool rises = value_at(slope, degree, low) > 0;
        if (rises == (value_at(slope, degree, high) > 0)) continue;
        for (double t = 0.5 * (low + high); low < t && t < high; t = 0.5 * (low + high)) {
            ((value_at(slope, degree, t) > 0) == rises ? low : high) = t;
        }
        return low;
    }
    return 0.5;
}

void divide(HeightPatch patch, std::uint32_t index, std::vector<MonotoneCell>& cells) {
    const Range range = height_range(patch);
    const Slopes u = slopes(patch, true, range), v = slopes(patch, false, range);
    const auto emit = [&](CellKind kind, double steepest) {
        cells.push_back({patch.from_u, patch.to_u, patch.from_v, patch.to_v, kind, u.high > 0,
                         v.high > 0, index, steepest});
    };
    // Differences times these are derivatives.
    const double by_u = patch.degree_u / (patch.to_u - patch.from_u);
    const double by_v = patch.degree_v / (patch.to_v - patch.from_v);
    if (v.steady()) return emit(CellKind::graph_over_u, by_u * u.most() / (by_v * v.least()));
    if (u.steady()) return emit(CellKind::graph_over_v, by_v * v.most() / (by_u * u.least()));
    if (u.one_sign() && v.one_sign()) return emit(CellKind::both, 0);
    if (range.high - range.low <= flat_cell_mm) return emit(CellKind::flat, 0);
    const Bending bend = bending(patch);
    const bool along_u = bend.along_u > bend.along_v;
    const double t = division(patch, along_u);
    const double from = along_u ? patch.from_u : patch.from_v;
    const double to = along_u ? patch.to_u : patch.to_v;
    const double at = from + t * (to - from);
    // No parameter is left between the borders: a fold in the surface's own parameters.
    if (!(from < at && at < to)) return emit(CellKind::flat, 0);
    HeightPatch high = patch;
    std::vector<double> low_z, low_w;
    split_coefficients(patch, patch.z, along_u, t, low_z, high.z);
    split_coefficients(patch, patch.w, along_u, t, low_w, high.w);
    patch.z = std::move(low_z);
    patch.w = std::move(low_w);
    (along_u ? patch.to_u : patch.to_v) = at;
    (along_u ? high.from_u : high.from_v) = at;
    divide(std::move(patch), index, cells);
    divide(std::move(high), index, cells);
}

}  // namespace

void append_monotone_cells(const BezierPatch& patch, std::uint32_t index,
                           std::vector<MonotoneCell>& cells) {
    HeightPatch height{patch.degree_u, patch.degree_v, {},           {},
                       patch.from_u,   patch.to_u,     patch.from_v, patch.to_v};
    bool rational = false;
    for (const Eigen::Vector4d& point : patch.control_points) {
        height.z.push_back(point.z());
        height.w.push_back(point.w());
        rational = rational || point.w() != 1;
    }
    if (!rational) height.w.clear();
    divide(std::move(height), index, cells);
}

}  // namespace lyr
