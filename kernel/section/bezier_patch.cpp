#include "kernel/section/bezier_patch.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/root.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/monotone_cells.h"

namespace lyr {
namespace {

using Row = std::array<double, highest_surface_degree + 1>;

// Bernstein polynomials of a degree at t, and their derivatives.
void bernstein_basis(int degree, double t, Row& value, Row& slope) {
    const auto n = static_cast<std::size_t>(degree);
    value[0] = 1;
    slope.fill(0);
    for (std::size_t d = 1; d <= n; ++d) {
        if (d == n) {
            // From degree n - 1: B'_i = n (B_{i-1} - B_i).
            const auto factor = static_cast<double>(n);
            slope[0] = -factor * value[0];
            for (std::size_t i = 1; i < n; ++i) slope[i] = factor * (value[i - 1] - value[i]);
            slope[n] = factor * value[n - 1];
        }
        value[d] = t * value[d - 1];
        for (std::size_t i = d - 1; i > 0; --i) value[i] = t * value[i - 1] + (1 - t) * value[i];
        value[0] *= 1 - t;
    }
}

void split(const Row& line, int degree, double t, Row& left, Row& right) {
    right = line;
    for (int level = degree; level >= 0; --level) {
        left[static_cast<std::size_t>(degree - level)] = right[0];
        for (std::size_t i = 0; i < static_cast<std::size_t>(level); ++i) {
            right[i] = (1 - t) * right[i] + t * right[i + 1];
        }
    }
}

// A stretch of an iso-line in its own Bernstein form.
struct Stretch {
    int degree;
    double from, to;
    Row z, w;

    // +1 rises, -1 falls, 0 neither is proved. The derivative on level h has the sign of Z' - h W'.
    int direction() const {
        const auto [low, high] = range();
        bool rises = true, falls = true;
        for (std::size_t i = 0; i < static_cast<std::size_t>(degree); ++i) {
            const double dz = z[i + 1] - z[i], dw = w[i + 1] - w[i];
            const double a = dz - low * dw, b = dz - high * dw;
            rises = rises && a >= 0 && b >= 0;
            falls = falls && a <= 0 && b <= 0;
        }
        return rises ? 1 : falls ? -1 : 0;
    }
    std::pair<double, double> range() const {
        double low = z[0] / w[0], high = low;
        for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) {
            low = std::min(low, z[i] / w[i]);
            high = std::max(high, z[i] / w[i]);
        }
        return {low, high};
    }
};

// Goes through the stretch from left to right; `last` is the direction so far.
void append_turns(const Stretch& stretch, int& last, std::vector<double>& turns) {
    const int direction = stretch.direction();
    if (direction != 0) {
        if (last != 0 && direction != last) turns.push_back(stretch.from);
        last = direction;
        return;
    }
    const auto [low, high] = stretch.range();
    const double middle = 0.5 * (stretch.from + stretch.to);
    if (high - low <= flat_cell_mm || !(stretch.from < middle && middle < stretch.to)) return;
    Stretch left{stretch.degree, stretch.from, middle, {}, {}};
    Stretch right{stretch.degree, middle, stretch.to, {}, {}};
    split(stretch.z, stretch.degree, 0.5, left.z, right.z);
    split(stretch.w, stretch.degree, 0.5, left.w, right.w);
    append_turns(left, last, turns);
    append_turns(right, last, turns);
}

}  // namespace

Partials partials(const BezierPatch& patch, const Point2& uv) {
    const double width_u = patch.to_u - patch.from_u, width_v = patch.to_v - patch.from_v;
    Row u, v, du, dv;
    bernstein_basis(patch.degree_u, (uv.x() - patch.from_u) / width_u, u, du);
    bernstein_basis(patch.degree_v, (uv.y() - patch.from_v) / width_v, v, dv);
    using Eigen::Vector4d;
    Vector4d point = Vector4d::Zero(), by_u = Vector4d::Zero(), by_v = Vector4d::Zero();
    const auto rows = static_cast<std::size_t>(patch.degree_u) + 1;
    const auto columns = static_cast<std::size_t>(patch.degree_v) + 1;
    for (std::size_t i = 0; i < rows; ++i) {
        Vector4d row = Vector4d::Zero(), row_by_v = Vector4d::Zero();
        for (std::size_t j = 0; j < columns; ++j) {
            const Vector4d& control = patch.control_points[i * columns + j];
            row += v[j] * control;
            row_by_v += dv[j] * control;
        }
        point += u[i] * row;
        by_u += du[i] * row;
        by_v += u[i] * row_by_v;
    }
    const Point3 at = point.head<3>() / point.w();
    return {at, (by_u.head<3>() - by_u.w() * at) / (point.w() * width_u),
            (by_v.head<3>() - by_v.w() * at) / (point.w() * width_v)};
}

IsoLine::IsoLine(const BezierPatch& patch, bool along_u, double fixed)
    : degree_(along_u ? patch.degree_u : patch.degree_v),
      from_(along_u ? patch.from_u : patch.from_v),
      width_(along_u ? patch.to_u - patch.from_u : patch.to_v - patch.from_v) {
    const double across_from = along_u ? patch.from_v : patch.from_u;
    const double across_to = along_u ? patch.to_v : patch.to_u;
    Row basis, unused;
    const int across = along_u ? patch.degree_v : patch.degree_u;
    bernstein_basis(across, (fixed - across_from) / (across_to - across_from), basis, unused);
    const auto columns = static_cast<std::size_t>(patch.degree_v) + 1;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i) {
        z_[i] = w_[i] = 0;
        for (std::size_t k = 0; k <= static_cast<std::size_t>(across); ++k) {
            const auto& control = patch.control_points[along_u ? i * columns + k : k * columns + i];
            z_[i] += basis[k] * control.z();
            w_[i] += basis[k] * control.w();
        }
    }
}

std::pair<double, double> IsoLine::above(double level_mm, double parameter) const {
    const double t = (parameter - from_) / width_;
    const auto n = static_cast<std::size_t>(degree_);
    Row c;
    for (std::size_t i = 0; i <= n; ++i) c[i] = z_[i] - level_mm * w_[i];
    for (std::size_t level = n; level > 1; --level) {
        for (std::size_t i = 0; i < level; ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
    }
    if (n == 0) return {c[0], 0};
    const double slope = static_cast<double>(n) * (c[1] - c[0]) / width_;
    return {(1 - t) * c[0] + t * c[1], slope};
}

double IsoLine::crossing(double level_mm, double start, double end, bool above_at_start) const {
    // A hundredth of what counts as a length: polishing further moves no point.
    constexpr double height_accuracy_mm = resolution_mm / 100;
    const auto f = [&](double parameter) { return above(level_mm, parameter); };
    const double low = f(start).first, high = f(end).first;
    const double guess = low != high ? start + (end - start) * low / (low - high) : start;
    return bracketed_root(f, start, end, above_at_start, guess, height_accuracy_mm * w_[0]);
}

void IsoLine::append_turns(double start, double end, std::vector<double>& turns) const {
    const Stretch whole{degree_, from_, from_ + width_, z_, w_};
    Stretch before, rest, inside, after;
    before = rest = inside = after = whole;
    // First what lies before `start` is cut off, then what lies behind `end`.
    split(whole.z, degree_, (start - from_) / width_, before.z, rest.z);
    split(whole.w, degree_, (start - from_) / width_, before.w, rest.w);
    const double share = (end - start) / (from_ + width_ - start);
    split(rest.z, degree_, share, inside.z, after.z);
    split(rest.w, degree_, share, inside.w, after.w);
    inside.from = start;
    inside.to = end;
    int last = 0;
    lyr::append_turns(inside, last, turns);
}

}  // namespace lyr
