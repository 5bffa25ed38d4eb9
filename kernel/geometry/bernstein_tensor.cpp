// Coefficients scaled by binomials multiply like those of ordinary polynomials; everything else is differences and
// de Casteljau's algorithm, line by line.

#include "kernel/geometry/bernstein_tensor.h"

#include <algorithm>
#include <cmath>

namespace lyr::bernstein {

namespace {

std::vector<double> binomials(std::size_t degree) {
    std::vector<double> row(degree + 1, 1.0);
    for (std::size_t i = 1; i < row.size(); ++i) {
        row[i] = row[i - 1] * static_cast<double>(degree - i + 1) / static_cast<double>(i);
    }
    return row;
}

// By the binomials of both degrees, or by their inverses.
Tensor scaled(Tensor a, bool inverse) {
    const std::vector<double> u = binomials(a.degree_u), v = binomials(a.degree_v);
    for (std::size_t i = 0; i <= a.degree_u; ++i) {
        for (std::size_t j = 0; j <= a.degree_v; ++j) {
            a.at(i, j) *= inverse ? 1 / (u[i] * v[j]) : u[i] * v[j];
        }
    }
    return a;
}

// The lines of coefficients along a parameter: `count` values `stride` apart.
struct Lines {
    std::size_t lines, count, stride, step;

    Lines(const Tensor& a, int along)
        : lines((along == 0 ? a.degree_v : a.degree_u) + 1),
          count((along == 0 ? a.degree_u : a.degree_v) + 1),
          stride(along == 0 ? a.degree_v + 1 : 1),
          step(along == 0 ? 1 : a.degree_v + 1) {}
};

Tensor with_degree(const Tensor& a, int along, std::size_t degree) {
    return along == 0 ? constant(0, degree, a.degree_v) : constant(0, a.degree_u, degree);
}

// De Casteljau's algorithm: the line on [0, t], or on [t, 1].
void cut(double* line, const Lines& lines, double t, bool keep_start) {
    for (std::size_t level = 1; level < lines.count; ++level) {
        for (std::size_t k = 0; k + level < lines.count; ++k) {
            const std::size_t i = keep_start ? lines.count - 1 - k : k;
            double& value = line[i * lines.stride];
            const double before = keep_start ? line[(i - 1) * lines.stride] : value;
            const double after = keep_start ? value : line[(i + 1) * lines.stride];
            value = (1 - t) * before + t * after;
        }
    }
}

double value_at(std::vector<double> line, double t) {
    for (std::size_t level = line.size() - 1; level > 0; --level) {
        for (std::size_t i = 0; i < level; ++i) line[i] = (1 - t) * line[i] + t * line[i + 1];
    }
    return line[0];
}

}  // namespace

Tensor constant(double value, std::size_t degree_u, std::size_t degree_v) {
    return {degree_u, degree_v, std::vector<double>((degree_u + 1) * (degree_v + 1), value)};
}

Tensor product(const Tensor& a, const Tensor& b) {
    const Tensor left = scaled(a, false), right = scaled(b, false);
    Tensor result = constant(0, a.degree_u + b.degree_u, a.degree_v + b.degree_v);
    for (std::size_t i = 0; i <= a.degree_u; ++i) {
        for (std::size_t j = 0; j <= a.degree_v; ++j) {
            const double factor = left.at(i, j);
            for (std::size_t k = 0; k <= b.degree_u; ++k) {
                double* const row = &result.at(i + k, j);
                const double* const other = &right.coefficients[k * (b.degree_v + 1)];
                for (std::size_t l = 0; l <= b.degree_v; ++l) row[l] += factor * other[l];
            }
        }
    }
    return scaled(std::move(result), true);
}

Tensor3 product(const Tensor& a, const Tensor3& b) {
    return {product(a, b[0]), product(a, b[1]), product(a, b[2])};
}

Tensor sum(Tensor a, const Tensor& b, double factor) {
    for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
        a.coefficients[i] += factor * b.coefficients[i];
    }
    return a;
}

Tensor3 sum(Tensor3 a, const Tensor3& b, double factor) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = sum(std::move(a[i]), b[i], factor);
    return a;
}

Tensor dot(const Tensor3& a, const Tensor3& b) {
    return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
}

Tensor3 cross(const Tensor3& a, const Tensor3& b) {
    const auto component = [&](std::size_t i, std::size_t j) {
        return sum(product(a[i], b[j]), product(a[j], b[i]), -1);
    };
    return {component(1, 2), component(2, 0), component(0, 1)};
}

Tensor derivative(const Tensor& a, int along) {
    const Lines lines(a, along);
    if (lines.count == 1) return with_degree(a, along, 0);
    Tensor result = with_degree(a, along, lines.count - 2);
    const Lines target(result, along);
    const auto degree = static_cast<double>(lines.count - 1);
    for (std::size_t line = 0; line < lines.lines; ++line) {
        for (std::size_t i = 0; i + 1 < lines.count; ++i) {
            const std::size_t k = line * lines.step + i * lines.stride;
            result.coefficients[line * target.step + i * target.stride] =
                degree * (a.coefficients[k + lines.stride] - a.coefficients[k]);
        }
    }
    return result;
}

Tensor3 derivative(const Tensor3& a, int along) {
    return {derivative(a[0], along), derivative(a[1], along), derivative(a[2], along)};
}

double evaluate(const Tensor& a, double u, double v) {
    std::vector<double> column(a.degree_u + 1);
    for (std::size_t i = 0; i <= a.degree_u; ++i) {
        const auto row = a.coefficients.begin() + static_cast<std::ptrdiff_t>(i * (a.degree_v + 1));
        column[i] = value_at({row, row + static_cast<std::ptrdiff_t>(a.degree_v + 1)}, v);
    }
    return value_at(std::move(column), u);
}

Tensor part(const Tensor& a, int along, double from, double to) {
    Tensor result = a;
    const Lines lines(a, along);
    for (std::size_t line = 0; line < lines.lines; ++line) {
        double* const first = &result.coefficients[line * lines.step];
        if (to < 1) cut(first, lines, to, true);
        if (from > 0) cut(first, lines, from / to, false);
    }
    return result;
}

Bounds bounds(const Tensor& a) {
    const auto [low, high] = std::minmax_element(a.coefficients.begin(), a.coefficients.end());
    return {*low, *high};
}

double largest_on(const Tensor& a, const Side& side) {
    const Lines lines(a, side.along);
    const std::size_t first = side.at_end ? (lines.count - 1) * lines.stride : 0;
    double largest = 0;
    for (std::size_t line = 0; line < lines.lines; ++line) {
        largest = std::max(largest, std::abs(a.coefficients[first + line * lines.step]));
    }
    return largest;
}

Tensor divided_by_distance(const Tensor& a, const Side& side) {
    const Lines lines(a, side.along);
    Tensor result = with_degree(a, side.along, lines.count - 2);
    const Lines target(result, side.along);
    for (std::size_t line = 0; line < lines.lines; ++line) {
        for (std::size_t i = 0; i + 1 < lines.count; ++i) {
            // t B(i, n - 1) = (i + 1) / n B(i + 1, n), and the same from the other end.
            const std::size_t from = side.at_end ? i : i + 1;
            const std::size_t weight = side.at_end ? lines.count - 1 - i : i + 1;
            result.coefficients[line * target.step + i * target.stride] =
                a.coefficients[line * lines.step + from * lines.stride] *
                static_cast<double>(lines.count - 1) / static_cast<double>(weight);
        }
    }
    return result;
}

}  // namespace lyr::bernstein
