// The height of a rational patch is Z / W, both polynomials. On the level h its derivative has the sign of
// Z' - h W', which is linear in h: it keeps one sign for every h of the cell's range if it does at both ends of it.

#include "kernel/section/monotone_cells.h"

#include <algorithm>
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

// How much the differences along one parameter change in the direction of u and of v, as shares of their size.
struct Bending {
    double along_u = 0, along_v = 0;
};

void add_bending(const HeightPatch& patch, bool of_u, const Slopes& slope, Bending& bending) {
    const double size = std::max(std::abs(slope.low), std::abs(slope.high));
    if (size == 0) return;
    const int last_i = patch.degree_u - (of_u ? 1 : 0), last_j = patch.degree_v - (of_u ? 0 : 1);
    const auto difference = [&](int i, int j) {
        return patch.z[of_u ? patch.at(i + 1, j) : patch.at(i, j + 1)] - patch.z[patch.at(i, j)];
    };
    double most_u = 0, most_v = 0;
    for (int i = 0; i <= last_i; ++i) {
        for (int j = 0; j <= last_j; ++j) {
            if (i < last_i) {
                most_u = std::max(most_u, std::abs(difference(i + 1, j) - difference(i, j)));
            }
            if (j < last_j) {
                most_v = std::max(most_v, std::abs(difference(i, j + 1) - difference(i, j)));
            }
        }
    }
    bending.along_u += most_u / size;
    bending.along_v += most_v / size;
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

// Where the derivative changes its sign along the patch's middle line, or else the middle.
double division(const HeightPatch& patch, bool along_u) {
    const int count = along_u ? patch.degree_u + 1 : patch.degree_v + 1;
    const int across = along_u ? patch.degree_v + 1 : patch.degree_u + 1;
    double middle[highest_surface_degree + 1], work[highest_surface_degree + 1];
    for (int i = 0; i < count; ++i) {
        for (int k = 0; k < across; ++k) {
            const std::size_t at = along_u ? patch.at(i, k) : patch.at(k, i);
            work[k] = patch.w.empty() ? patch.z[at] : patch.z[at] / patch.w[at];
        }
        for (int level = across - 1; level > 0; --level) {
            for (int k = 0; k < level; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
        }
        middle[i] = work[0];
    }
    // The control polygon's turn is near the curve's: good enough to aim at, and the next division aims better.
    const auto slope = [&](double t) {
        double d[highest_surface_degree + 1];
        for (int i = 0; i + 1 < count; ++i) d[i] = middle[i + 1] - middle[i];
        for (int level = count - 2; level > 0; --level) {
            for (int i = 0; i < level; ++i) d[i] = (1 - t) * d[i] + t * d[i + 1];
        }
        return d[0];
    };
    constexpr double nearest_border = 1.0 / 16;
    double low = nearest_border, high = 1 - nearest_border;
    const bool rises = slope(low) > 0;
    if (count < 3 || rises == (slope(high) > 0)) return 0.5;
    while (true) {
        const double t = 0.5 * (low + high);
        if (t <= low || t >= high) return t;
        ((slope(t) > 0) == rises ? low : high) = t;
    }
}

void divide(HeightPatch patch, std::uint32_t index, std::vector<MonotoneCell>& cells) {
    const Range range = height_range(patch);
    const Slopes u = slopes(patch, true, range), v = slopes(patch, false, range);
    const auto emit = [&](CellKind kind) {
        cells.push_back({patch.from_u, patch.to_u, patch.from_v, patch.to_v, kind, u.high > 0,
                         v.high > 0, index});
    };
    if (v.steady()) return emit(CellKind::graph_over_u);
    if (u.steady()) return emit(CellKind::graph_over_v);
    if (u.one_sign() && v.one_sign()) return emit(CellKind::both);
    if (range.high - range.low <= flat_cell_mm) return emit(CellKind::flat);
    Bending bending;
    add_bending(patch, true, u, bending);
    add_bending(patch, false, v, bending);
    const bool along_u = bending.along_u > bending.along_v;
    const double t = division(patch, along_u);
    const double from = along_u ? patch.from_u : patch.from_v;
    const double to = along_u ? patch.to_u : patch.to_v;
    const double at = from + t * (to - from);
    // No parameter is left between the borders: a fold in the surface's own parameters.
    if (!(from < at && at < to)) return emit(CellKind::flat);
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
