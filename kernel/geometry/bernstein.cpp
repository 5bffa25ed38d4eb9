// Polynomials in Bernstein form: de Casteljau's algorithm for values and subdivision, and isolation of roots by
// Descartes' rule of signs.

#include "kernel/geometry/bernstein.h"

#include <algorithm>

#include "kernel/geometry/root.h"

namespace lyr::bernstein {

namespace {

// {value, derivative} by de Casteljau: every step is a convex combination, so errors do not grow.
std::pair<double, double> value_and_slope(const Coefficients& c, Coefficients& work, double t) {
    work = c;
    double slope = 0;
    for (std::size_t level = work.size() - 1; level > 0; --level) {
        if (level == 1) slope = static_cast<double>(c.size() - 1) * (work[1] - work[0]);
        for (std::size_t i = 0; i < level; ++i) work[i] = (1 - t) * work[i] + t * work[i + 1];
    }
    return {work[0], slope};
}

void isolate_in(const Coefficients& c, double from, double to, const Negligible& negligible,
                std::vector<double>& roots) {
    const int variations = sign_variations(c);
    if (variations == 0) return;
    if (variations == 1) {
        roots.push_back(from + (to - from) * single_root(c));
        return;
    }
    // Halving beyond this meets the spacing of doubles in [0, 1].
    constexpr double smallest_width = 1e-15;
    if (to - from < smallest_width || negligible(c, to - from)) {
        roots.push_back(0.5 * (from + to));
        return;
    }
    const double middle = 0.5 * (from + to);
    const auto [left, right] = split(c, 0.5);
    isolate_in(left, from, middle, negligible, roots);
    // A root on the very middle is a zero end coefficient on both sides, which neither counts.
    if (right.front() == 0) roots.push_back(middle);
    isolate_in(right, middle, to, negligible, roots);
}

}  // namespace

double evaluate(const Coefficients& c, double t) {
    Coefficients work;
    return value_and_slope(c, work, t).first;
}

Coefficients derivative(const Coefficients& c) {
    if (c.size() == 1) return {0.0};
    const auto degree = static_cast<double>(c.size() - 1);
    Coefficients d(c.size() - 1);
    for (std::size_t i = 0; i < d.size(); ++i) d[i] = degree * (c[i + 1] - c[i]);
    return d;
}

Coefficients product(const Coefficients& a, const Coefficients& b) {
    // The coefficient of degree m scaled by binomial(m, i) multiplies like an ordinary polynomial.
    const auto binomials = [](std::size_t degree) {
        Coefficients row(degree + 1, 1.0);
        for (std::size_t i = 1; i < row.size(); ++i) {
            row[i] = row[i - 1] * static_cast<double>(degree - i + 1) / static_cast<double>(i);
        }
        return row;
    };
    const std::size_t m = a.size() - 1, n = b.size() - 1;
    const Coefficients row_a = binomials(m), row_b = binomials(n), row = binomials(m + n);
    Coefficients result(m + n + 1, 0.0);
    for (std::size_t i = 0; i <= m; ++i) {
        for (std::size_t j = 0; j <= n; ++j) {
            result[i + j] += row_a[i] * row_b[j] / row[i + j] * a[i] * b[j];
        }
    }
    return result;
}

Coefficients difference(const Coefficients& a, const Coefficients& b) {
    Coefficients result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
    return result;
}

int sign_variations(const Coefficients& c) {
    int variations = 0;
    double last = 0;
    for (const double value : c) {
        if (value == 0) continue;
        if (last != 0 && (value > 0) != (last > 0)) ++variations;
        last = value;
    }
    return variations;
}

std::pair<Coefficients, Coefficients> split(const Coefficients& c, double t) {
    Coefficients left(c.size()), right = c;
    for (std::size_t level = c.size(); level > 0; --level) {
        left[c.size() - level] = right[0];
        for (std::size_t i = 0; i + 1 < level; ++i)
            right[i] = (1 - t) * right[i] + t * right[i + 1];
    }
    return {std::move(left), std::move(right)};
}

double single_root(const Coefficients& c) {
    const auto first = std::find_if(c.begin(), c.end(), [](double value) { return value != 0; });
    Coefficients work;
    const auto f = [&](double t) { return value_and_slope(c, work, t); };
    const double span = c.front() - c.back();
    const double guess = span != 0 ? c.front() / span : 0.5;
    return bracketed_root(f, 0, 1, *first > 0, guess, 0);
}

std::vector<double> isolate(const Coefficients& c, const Negligible& negligible) {
    std::vector<double> roots;
    isolate_in(c, 0, 1, negligible, roots);
    return roots;
}

}  // namespace lyr::bernstein
