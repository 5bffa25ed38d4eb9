// On a patch S = P / w, and N = w Pu x Pv + wv P x Pu - wu P x Pv, a polynomial, has the direction of the normal. Let
// D = A - S for the approximation A. It is the offset if D is parallel to N and |D| = |d|; how far it is off follows
// from
//     t = |D x N| / |N|         across the normal
//     | |D|^2 - d^2 | <= q      hence along it, where D.N keeps its sign, | |D.n| - |d| | <= (q + t^2) / |d|
// in which everything but the division by the smallest |N| is a polynomial, bounded by its Bernstein coefficients. That
// A does not fold is the sign of (Au x Av).N, bounded the same way. At a pole N vanishes on a whole side; the factor
// that makes it vanish, the distance from the side, is divided out first.

#include "kernel/geometry/offset_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/geometry/interpolation.h"
#include "kernel/geometry/tolerance.h"

namespace lyr::offset_patch {

using bernstein::Bounds;
using bernstein::Tensor;
using bernstein::Tensor3;

namespace {

// Polynomials this much smaller on a side than elsewhere vanish there: a thousand times the round-off of products.
constexpr double vanishing = 1e-11;

// Of the degrees given, which are no lower.
Tensor raised(const Tensor& a, std::size_t degree_u, std::size_t degree_v) {
    return product(a, bernstein::constant(1, degree_u - a.degree_u, degree_v - a.degree_v));
}
Tensor3 raised(const Tensor3& a, std::size_t degree_u, std::size_t degree_v) {
    return {raised(a[0], degree_u, degree_v), raised(a[1], degree_u, degree_v),
            raised(a[2], degree_u, degree_v)};
}

Vector3 value(const Tensor3& a, double u, double v) {
    return {evaluate(a[0], u, v), evaluate(a[1], u, v), evaluate(a[2], u, v)};
}

bool vanishes_on(const Tensor3& a, const bernstein::Side& side) {
    double on_side = 0, anywhere = 0;
    for (const Tensor& c : a) {
        on_side = std::max(on_side, largest_on(c, side));
        anywhere = std::max(anywhere, bounds(c).magnitude());
    }
    return on_side <= vanishing * anywhere;
}

Tensor3 normal_direction(Piece& piece) {
    const Tensor3& p = piece.point;
    const Tensor3 du = derivative(p, 0), dv = derivative(p, 1);
    Tensor3 n = cross(du, dv);
    if (piece.weight.coefficients.size() > 1) {
        n = product(piece.weight, n);
        n = sum(n, product(derivative(piece.weight, 1), cross(p, du)));
        n = sum(n, product(derivative(piece.weight, 0), cross(p, dv)), -1);
    }
    for (std::size_t k = 0; k < bernstein::sides.size(); ++k) {
        const bernstein::Side& side = bernstein::sides[k];
        const auto degree = [&] { return side.along == 0 ? n[0].degree_u : n[0].degree_v; };
        while (degree() > 0 && vanishes_on(n, side)) {
            piece.pole[k] = true;
            for (Tensor& c : n) c = divided_by_distance(c, side);
        }
    }
    return n;
}

Tensor part(const Tensor& a, const Stretch& u, const Stretch& v) {
    return part(part(a, 0, u.low, u.high), 1, v.low, v.high);
}

Tensor3 tensor_of(const Net& net, const Point3& origin) {
    const Tensor zero = bernstein::constant(0, static_cast<std::size_t>(net.degree_u),
                                            static_cast<std::size_t>(net.degree_v));
    Tensor3 result{zero, zero, zero};
    for (std::size_t k = 0; k < net.points.size(); ++k) {
        for (int i = 0; i < 3; ++i) {
            result[static_cast<std::size_t>(i)].coefficients[k] = net.points[k][i] - origin[i];
        }
    }
    return result;
}

// Of the largest value on the square: by quarters, whose coefficients are closer to the values. The error of an
// interpolation rises and falls, and coefficients far more so.
double magnitude(const Tensor& a) {
    double largest = 0;
    for (const double u : {0.0, 0.5}) {
        const Tensor half = part(a, 0, u, u + 0.5);
        for (const double v : {0.0, 0.5}) {
            largest = std::max(largest, bounds(part(half, 1, v, v + 0.5)).magnitude());
        }
    }
    return largest;
}

// Of a polynomial on the square: by its coefficients, else by those of its parts.
Sign sign_of(const Tensor& f, int depth) {
    const Bounds all = bounds(f);
    if (all.low > 0) return Sign::positive;
    if (all.high < 0) return Sign::negative;
    const auto [low, high] = std::minmax(
        {f.at(0, 0), f.at(f.degree_u, 0), f.at(0, f.degree_v), f.at(f.degree_u, f.degree_v)});
    if (low < 0 && high > 0) return Sign::mixed;
    if (depth == 0) return Sign::unknown;
    const Sign first = sign_of(part(f, depth % 2, 0, 0.5), depth - 1);
    const Sign second = sign_of(part(f, depth % 2, 0.5, 1), depth - 1);
    if (first == Sign::mixed || second == Sign::mixed) return Sign::mixed;
    if (first == Sign::unknown || second == Sign::unknown) return Sign::unknown;
    return first == second ? first : Sign::mixed;
}

}  // namespace

Piece piece_of(const BezierPatch& patch, bool is_rational) {
    const auto m = static_cast<std::size_t>(patch.degree_u),
               n = static_cast<std::size_t>(patch.degree_v);
    const Eigen::Vector4d& first = patch.control_points.front();
    const Tensor zero = bernstein::constant(0, m, n);
    Piece piece{first.head<3>() / first.w(), {zero, zero, zero}, bernstein::constant(1, 0, 0)};
    if (is_rational) piece.weight = zero;
    for (std::size_t k = 0; k < patch.control_points.size(); ++k) {
        const Eigen::Vector4d& c = patch.control_points[k];
        for (int i = 0; i < 3; ++i) {
            piece.point[static_cast<std::size_t>(i)].coefficients[k] =
                c[i] - c.w() * piece.origin[i];
        }
        if (is_rational) piece.weight.coefficients[k] = c.w();
    }
    return piece;
}

Piece part(const Piece& whole, const Stretch& u, const Stretch& v) {
    Piece piece = whole;
    for (Tensor& c : piece.point) c = part(c, u, v);
    piece.weight = part(piece.weight, u, v);
    piece.normal = normal_direction(piece);
    return piece;
}

Point3 surface_point(const Piece& piece, double u, double v) {
    return value(piece.point, u, v) / evaluate(piece.weight, u, v);
}

Vector3 unit_normal(const Piece& piece, double u, double v) {
    return value(piece.normal, u, v).normalized();
}

Net interpolated(const Piece& piece, double distance_mm, int degree_u, int degree_v) {
    const std::vector<double> u = interpolation::nodes(degree_u),
                              v = interpolation::nodes(degree_v);
    const Eigen::MatrixXd empty(degree_u + 1, degree_v + 1);
    std::array<Eigen::MatrixXd, 3> values{empty, empty, empty};
    for (int i = 0; i <= degree_u; ++i) {
        for (int j = 0; j <= degree_v; ++j) {
            const double at_u = u[static_cast<std::size_t>(i)],
                         at_v = v[static_cast<std::size_t>(j)];
            const Point3 p =
                surface_point(piece, at_u, at_v) + distance_mm * unit_normal(piece, at_u, at_v);
            for (int k = 0; k < 3; ++k) values[static_cast<std::size_t>(k)](i, j) = p[k];
        }
    }
    const Eigen::MatrixXd along_u = interpolation::bernstein_from_values(degree_u);
    const Eigen::MatrixXd along_v = interpolation::bernstein_from_values(degree_v).transpose();
    for (Eigen::MatrixXd& m : values) m = along_u * m * along_v;
    const auto& [x, y, z] = values;
    Net net{degree_u, degree_v, {}};
    for (int i = 0; i <= degree_u; ++i) {
        for (int j = 0; j <= degree_v; ++j) {
            net.points.push_back(piece.origin + Point3(x(i, j), y(i, j), z(i, j)));
        }
    }
    return net;
}

void collapse(Net& net, const bernstein::Side& side) {
    constexpr double round_off_mm = resolution_mm / 1000;
    const auto rows = static_cast<std::size_t>(net.degree_u + 1),
               columns = static_cast<std::size_t>(net.degree_v + 1);
    const std::size_t stride = side.along == 0 ? 1 : columns;
    const std::size_t first = !side.at_end      ? 0
                              : side.along == 0 ? (rows - 1) * columns
                                                : columns - 1;
    const std::size_t last = first + stride * ((side.along == 0 ? columns : rows) - 1);
    const Point3 pole = net.points[first];
    for (std::size_t k = first; k <= last; k += stride) {
        if ((net.points[k] - pole).norm() > round_off_mm) return;
    }
    for (std::size_t k = first; k <= last; k += stride) net.points[k] = pole;
}

double error_bound_mm(const Piece& piece, const Net& approximation, double distance_mm) {
    const Tensor3 net = tensor_of(approximation, piece.origin);
    const std::size_t m = piece.point[0].degree_u + net[0].degree_u,
                      n = piece.point[0].degree_v + net[0].degree_v;
    // w (A - S)
    const Tensor3 apart =
        sum(raised(product(piece.weight, net), m, n), raised(piece.point, m, n), -1);
    const double weight = bounds(piece.weight).low;
    const Vector3 middle = value(piece.normal, 0.5, 0.5).normalized();
    Tensor along = bernstein::constant(0, piece.normal[0].degree_u, piece.normal[0].degree_v);
    for (std::size_t i = 0; i < 3; ++i) {
        along = sum(along, piece.normal[i], middle[static_cast<Eigen::Index>(i)]);
    }
    const double smallest_normal = bounds(along).low;
    if (!(smallest_normal > 0 && weight > 0)) return std::numeric_limits<double>::infinity();
    double across2 = 0;
    for (const Tensor& c : cross(apart, piece.normal)) {
        across2 += std::pow(magnitude(c) / (weight * smallest_normal), 2);
    }
    const Tensor weight2 = raised(product(piece.weight, piece.weight), 2 * m, 2 * n);
    const Tensor excess = sum(dot(apart, apart), weight2, -distance_mm * distance_mm);
    const double along_mm =
        (magnitude(excess) / (weight * weight) + across2) / std::abs(distance_mm);
    return std::hypot(along_mm, std::sqrt(across2));
}

Sign facing(const Piece& piece, const Net& approximation) {
    const Tensor3 net = tensor_of(approximation, piece.origin);
    Tensor f = dot(cross(derivative(net, 0), derivative(net, 1)), piece.normal);
    for (std::size_t k = 0; k < piece.pole.size(); ++k) {
        const bernstein::Side& side = bernstein::sides[k];
        const auto degree = [&] { return side.along == 0 ? f.degree_u : f.degree_v; };
        while (piece.pole[k] && degree() > 0 &&
               largest_on(f, side) <= vanishing * bounds(f).magnitude()) {
            f = divided_by_distance(f, side);
        }
    }
    constexpr int halvings = 6;
    return sign_of(f, halvings);
}

Vector2 unresolved_mm(const Net& net) {
    const auto highest = [](std::vector<Point3> line) {
        const std::size_t n = line.size() - 1;
        for (std::size_t level = n; level > 0; --level) {
            for (std::size_t i = 0; i < level; ++i) line[i] = line[i + 1] - line[i];
        }
        // Of a Chebyshev polynomial on [0, 1] with that leading coefficient.
        return n > 1 ? line[0].norm() * std::ldexp(1.0, 1 - 2 * static_cast<int>(n)) : 0.0;
    };
    const auto rows = static_cast<std::size_t>(net.degree_u + 1),
               columns = static_cast<std::size_t>(net.degree_v + 1);
    Vector2 result = Vector2::Zero();
    for (std::size_t j = 0; j < columns; ++j) {
        std::vector<Point3> line;
        for (std::size_t i = 0; i < rows; ++i) line.push_back(net.points[i * columns + j]);
        result.x() = std::max(result.x(), highest(std::move(line)));
    }
    for (std::size_t i = 0; i < rows; ++i) {
        const auto row = net.points.begin() + static_cast<std::ptrdiff_t>(i * columns);
        result.y() =
            std::max(result.y(), highest({row, row + static_cast<std::ptrdiff_t>(columns)}));
    }
    return result;
}

}  // namespace lyr::offset_patch
