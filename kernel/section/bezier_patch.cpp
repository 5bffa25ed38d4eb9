#include "kernel/section/bezier_patch.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/root.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/monotone_cells.h"

namespace lyr {
namespace {

using Row = std::array<double, highest_surface_degree + 1>;

// binomials[n][i]: exact in a double up to the highest degree.
constexpr auto binomials = [] {
    std::array<Row, highest_surface_degree + 1> table{};
    for (std::size_t n = 0; n < table.size(); ++n) {
        table[n][0] = 1;
        for (std::size_t i = 1; i <= n; ++i) {
            table[n][i] = table[n - 1][i - 1] + (i < n ? table[n - 1][i] : 0);
        }
    }
    return table;
}();

// Bernstein polynomials of a degree at t.
void bernstein_basis(std::size_t n, double t, Row& value) {
    double power = 1;
    for (std::size_t i = 0; i <= n; ++i, power *= t) value[i] = binomials[n][i] * power;
    power = 1;
    for (std::size_t i = n + 1; i-- > 0; power *= 1 - t) value[i] *= power;
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

// By all but the last step of de Casteljau's algorithm in both directions, which leaves the corners of a bilinear patch that
// touches this one there.
Partials partials(const BezierPatch& patch, const Point2& uv) {
    const double width_u = patch.to_u - patch.from_u, width_v = patch.to_v - patch.from_v;
    const double s = (uv.x() - patch.from_u) / width_u, t = (uv.y() - patch.from_v) / width_v;
    const auto degree_u = static_cast<std::size_t>(patch.degree_u);
    const auto degree_v = static_cast<std::size_t>(patch.degree_v);
    Row u, v;
    bernstein_basis(degree_u - 1, s, u);
    bernstein_basis(degree_v - 1, t, v);
    using Eigen::Vector4d;
    std::array<Vector4d, 2> low, high;  // by v: corners at the lower and the higher u
    low.fill(Vector4d::Zero());
    high.fill(Vector4d::Zero());
    const Vector4d* control = patch.control_points.data();
    for (std::size_t i = 0; i <= degree_u; ++i, ++control) {
        Vector4d left = Vector4d::Zero(), right = Vector4d::Zero();
        for (std::size_t j = 0; j < degree_v; ++j, ++control) {
            left += v[j] * control[0];
            right += v[j] * control[1];
        }
        const double at_low = i < degree_u ? u[i] : 0, at_high = i > 0 ? u[i - 1] : 0;
        low[0] += at_low * left;
        low[1] += at_low * right;
        high[0] += at_high * left;
        high[1] += at_high * right;
    }
    const Vector4d at_t = (1 - t) * low[0] + t * low[1], beyond = (1 - t) * high[0] + t * high[1];
    const Vector4d point = (1 - s) * at_t + s * beyond;
    const Vector4d by_u = patch.degree_u * (beyond - at_t);
    const Vector4d by_v = patch.degree_v * ((1 - s) * (low[1] - low[0]) + s * (high[1] - high[0]));
    const Point3 at = point.head<3>() / point.w();
    return {at, (by_u.head<3>() - by_u.w() * at) / (point.w() * width_u),
            (by_v.head<3>() - by_v.w() * at) / (point.w() * width_v)};
}

// The error of cubic Hermite interpolation is the fourth derivative / 4! times the square of t (1 - t), so at most / 384; the
// fourth derivative lies in the hull of n (n - 1) (n - 2) (n - 3) times the fourth differences.
QuarticPart quartic_part(const BezierPatch& patch) {
    const Eigen::Vector4d& first = patch.control_points.front();
    const Point3 origin = first.head<3>() / first.w();
    double reach = 0, least_weight = first.w();
    for (const Eigen::Vector4d& control : patch.control_points) {
        reach = std::max(reach, (control.head<3>() / control.w() - origin).norm());
        least_weight = std::min(least_weight, control.w());
    }
    const auto columns = static_cast<std::size_t>(patch.degree_v) + 1;
    const auto largest = [&](std::size_t stride, int degree, std::size_t lines,
                             std::size_t line_stride) {
        double most = 0;
        for (std::size_t line = 0; line < lines; ++line) {
            for (int i = 0; i + 4 <= degree; ++i) {
                const auto* c =
                    &patch
                         .control_points[line * line_stride + static_cast<std::size_t>(i) * stride];
                const Eigen::Vector4d d =
                    c[0] - 4 * c[stride] + 6 * c[2 * stride] - 4 * c[3 * stride] + c[4 * stride];
                // Of a quotient: that of the numerator, seen from the origin, and of the denominator.
                most =
                    std::max(most, (d.head<3>() - d.w() * origin).norm() + reach * std::abs(d.w()));
            }
        }
        return degree * (degree - 1.0) * (degree - 2.0) * (degree - 3.0) * most /
               (384 * least_weight);
    };
    const auto rows = static_cast<std::size_t>(patch.degree_u) + 1;
    return {largest(columns, patch.degree_u, columns, 1),
            largest(1, patch.degree_v, rows, columns)};
}

IsoLine::IsoLine(const BezierPatch& patch, bool along_u, double fixed)
    : degree_(along_u ? patch.degree_u : patch.degree_v),
      from_(along_u ? patch.from_u : patch.from_v),
      width_(along_u ? patch.to_u - patch.from_u : patch.to_v - patch.from_v) {
    const double across_from = along_u ? patch.from_v : patch.from_u;
    const double across_to = along_u ? patch.to_v : patch.to_u;
    Row basis;
    const auto across = static_cast<std::size_t>(along_u ? patch.degree_v : patch.degree_u);
    bernstein_basis(across, (fixed - across_from) / (across_to - across_from), basis);
    const auto columns = static_cast<std::size_t>(patch.degree_v) + 1;
    const std::size_t stride = along_u ? columns : 1, across_stride = along_u ? 1 : columns;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i) {
        Eigen::Vector2d zw = Eigen::Vector2d::Zero();
        const Eigen::Vector4d* control = &patch.control_points[i * stride];
        for (std::size_t k = 0; k <= across; ++k, control += across_stride)
            zw += basis[k] * control->tail<2>();
        z_[i] = zw.x();
        w_[i] = zw.y();
    }
}

// Nested multiplication in t / (1 - t), or its inverse beyond the middle, where it does not overflow (Volk & Schumaker,
// "An efficient algorithm for evaluating polynomials in Bernstein-Bezier form", Computing 46, 1991).
std::pair<double, double> IsoLine::value_and_slope(const Coefficients& scaled, double t) const {
    const auto n = static_cast<std::size_t>(degree_);
    const bool late = t > 0.5;
    const double near = late ? t : 1 - t, s = (1 - near) / near;
    double value = scaled[late ? 0 : n], slope = 0, power = 1;
    for (std::size_t i = n; i-- > 0;) {
        slope = slope * s + value;
        value = value * s + scaled[late ? n - i : i];
        power *= near;
    }
    // d/dt of near^n p(s), ds/dt = +-1 / near^2; near itself goes with or against t.
    const double by_near = static_cast<double>(n) * value - slope / near;
    return {power * value, (late ? 1 : -1) * power / near * by_near};
}

double IsoLine::crossing(double level_mm, double start, double end, bool above_at_start,
                         double guess) const {
    // A hundredth of what counts as a length: polishing further moves no point.
    constexpr double height_accuracy_mm = resolution_mm / 100;
    Coefficients scaled;
    const auto n = static_cast<std::size_t>(degree_);
    for (std::size_t i = 0; i <= n; ++i) scaled[i] = binomials[n][i] * (z_[i] - level_mm * w_[i]);
    const auto above = [&](double t) { return value_and_slope(scaled, t); };
    const double low = (start - from_) / width_, high = (end - from_) / width_;
    const double t = bracketed_root(above, low, high, above_at_start, (guess - from_) / width_,
                                    height_accuracy_mm * w_[0]);
    // Not a bit beyond the bounds.
    return std::clamp(from_ + t * width_, start, end);
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
