#include "target/home/least_squares.h"

#include <algorithm>
#include <cmath>

namespace lyr::home {
namespace {

// Columns, each with a row for every measurement.
using Columns = std::vector<Numbers>;

// A column that keeps less than this share of its length once the others are taken out says nothing of its own.
constexpr double tells_nothing = 1e-9;

double dot(const Numbers& a, const Numbers& b, std::size_t from) {
    double sum = 0;
    for (std::size_t i = from; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

// The x that brings columns * x closest to `right`.
std::optional<Numbers> solve(Columns columns, Numbers right) {
    const std::size_t unknowns = columns.size();
    Numbers diagonal(unknowns);
    for (std::size_t k = 0; k < unknowns; ++k) {
        Numbers& column = columns[k];
        const double whole = std::sqrt(dot(column, column, 0));
        const double left = std::sqrt(dot(column, column, k));
        if (!(left > tells_nothing * whole)) return std::nullopt;
        diagonal[k] = column[k] > 0 ? -left : left;
        column[k] -= diagonal[k];  // the mirror, from row k on
        const double size = dot(column, column, k);
        const auto reflect = [&](Numbers& other) {
            const double share = 2 * dot(column, other, k) / size;
            for (std::size_t i = k; i < other.size(); ++i) other[i] -= share * column[i];
        };
        for (std::size_t other = k + 1; other < unknowns; ++other) reflect(columns[other]);
        reflect(right);
    }
    Numbers x(unknowns);
    for (std::size_t k = unknowns; k-- > 0;) {
        double sum = right[k];
        for (std::size_t other = k + 1; other < unknowns; ++other)
            sum -= columns[other][k] * x[other];
        x[k] = sum / diagonal[k];
    }
    return x;
}

bool finite(const Numbers& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
}

}  // namespace

std::optional<Numbers> least_squares(const Residuals& residuals, Numbers begin,
                                     const Numbers& scale) {
    constexpr int most_steps = 30;
    constexpr double small = 1e-3, settled = 1e-9;  // of the scale
    Numbers at = std::move(begin);
    for (int step = 0; step < most_steps; ++step) {
        Numbers right = residuals(at);
        if (!finite(right) || right.size() < at.size()) return std::nullopt;
        for (double& number : right) number = -number;
        Columns columns;
        for (std::size_t k = 0; k < at.size(); ++k) {
            Numbers more = at, less = at;
            more[k] += small * scale[k];
            less[k] -= small * scale[k];
            Numbers column = residuals(more);
            const Numbers below = residuals(less);
            for (std::size_t i = 0; i < column.size(); ++i)
                column[i] = (column[i] - below[i]) / (2 * small);
            if (!finite(column)) return std::nullopt;
            columns.push_back(std::move(column));
        }
        const std::optional<Numbers> change = solve(std::move(columns), std::move(right));
        if (!change) return std::nullopt;
        double largest = 0;
        for (std::size_t k = 0; k < at.size(); ++k) {
            at[k] += (*change)[k] * scale[k];
            largest = std::max(largest, std::abs((*change)[k]));
        }
        if (largest < settled) return at;
    }
    return std::nullopt;
}

}  // namespace lyr::home
