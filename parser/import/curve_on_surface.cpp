// Formulas of the surface, once exactly where they come out as a curve of the kernel, once as functions to approximate.

#include "parser/import/curve_on_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/geometry/angle.h"
#include "kernel/geometry/bernstein.h"
#include "kernel/geometry/bspline_surface.h"
#include "parser/import/surface_functions.h"

namespace lyr::importer {

namespace {

using std::numbers::pi;

// --- exact ---

// A circle of a radius that may be negative: it begins on the other side then.
Curve circle(Frame frame, double radius_mm) {
    if (radius_mm < 0) {
        frame.x = -frame.x;
        frame.y = -frame.y;
    }
    return Circle{frame, std::abs(radius_mm)};
}

Eigen::Affine3d about(const Frame& axis, double angle_rad) {
    return Eigen::Translation3d(axis.origin) * Eigen::AngleAxisd(angle_rad, axis.z) *
           Eigen::Translation3d(-axis.origin);
}

// Lines of constant v (along_u) or constant u through a point given in parameters, in their sense.
struct IsoLine {
    using Result = std::optional<Curve>;

    Point2 at;
    bool along_u;
    double offset_mm;

    Result operator()(const Plane& s) const {
        return Line{evaluate(Surface(s), at), along_u ? s.frame.x : s.frame.y};
    }
    Result operator()(const Cylinder& s) const {
        if (along_u) return parallel(s.frame, s.radius_mm, at.y());
        return Line{evaluate(Surface(s), at), s.frame.z};
    }
    Result operator()(const Cone& s) const {
        const double slope = std::tan(s.half_angle_rad);
        if (along_u) return parallel(s.frame, s.radius_mm + at.y() * slope, at.y());
        const Vector3 along = slope * radial(s.frame) + s.frame.z;
        return Line{evaluate(Surface(s), at), along.normalized()};
    }
    Result operator()(const Sphere& s) const { return (*this)(Torus{s.frame, 0, s.radius_mm}); }
    Result operator()(const Torus& s) const {
        if (along_u) {
            return parallel(s.frame, s.major_mm + s.minor_mm * std::cos(at.y()),
                            s.minor_mm * std::sin(at.y()));
        }
        const Vector3 out = radial(s.frame);
        return circle({s.frame.origin + s.major_mm * out, out, s.frame.z, out.cross(s.frame.z)},
                      s.minor_mm);
    }
    Result operator()(const Extrusion& s) const {
        if (!along_u) return Line{point(s), s.direction};
        if (offset_mm != 0) return std::nullopt;
        return transformed(s.curve, Eigen::Affine3d(Eigen::Translation3d(at.y() * s.direction)));
    }
    Result operator()(const Revolution& s) const {
        if (!along_u) {
            if (offset_mm != 0) return std::nullopt;
            return transformed(s.curve, about(s.axis, at.x()));
        }
        // Where u begins, so that the circle counts as the surface does.
        const Point3 local = s.axis.to_local(about(s.axis, -at.x()) * point(s));
        Frame frame = s.axis;
        frame.origin += local.z() * frame.z;
        if (const double radius_mm = local.head<2>().norm(); radius_mm > resolution_mm) {
            frame.x = (local.x() * s.axis.x + local.y() * s.axis.y) / radius_mm;
            frame.y = frame.z.cross(frame.x);
            return Circle{frame, radius_mm};
        }
        return std::nullopt;
    }
    // Control points of the line are points of the lines across it.
    Result operator()(const SharedBSplineSurface& s) const {
        BSplineCurve curve{along_u ? s->degree_u : s->degree_v,
                           along_u ? s->knots_u : s->knots_v,
                           {},
                           {},
                           along_u ? s->closed_u : s->closed_v};
        for (std::size_t i = 0; i < (along_u ? s->count_u : s->count_v); ++i) {
            const auto [point, weight] = across(*s, i);
            curve.control_points.push_back(point);
            if (!s->weights.empty()) curve.weights.push_back(weight);
        }
        return curve;
    }

private:
    template <class Sweep>
    Point3 point(const Sweep& s) const {
        const Triple<double> p = PointOn<double>{at.x(), at.y(), at, offset_mm}(s);
        return {p[0], p[1], p[2]};
    }
    Vector3 radial(const Frame& frame) const {
        return std::cos(at.x()) * frame.x + std::sin(at.x()) * frame.y;
    }
    static Curve parallel(Frame frame, double radius_mm, double height_mm) {
        frame.origin += height_mm * frame.z;
        return circle(frame, radius_mm);
    }
    std::pair<Point3, double> across(const BSplineSurface& s, std::size_t i) const {
        BSplineCurve line{along_u ? s.degree_v : s.degree_u,
                          along_u ? s.knots_v : s.knots_u,
                          {},
                          {},
                          along_u ? s.closed_v : s.closed_u};
        BSplineCurve weight = line;
        for (std::size_t k = 0; k < (along_u ? s.count_v : s.count_u); ++k) {
            const std::size_t index = along_u ? i * s.count_v + k : k * s.count_v + i;
            line.control_points.push_back(s.control_points[index]);
            if (s.weights.empty()) continue;
            line.weights.push_back(s.weights[index]);
            weight.control_points.emplace_back(s.weights[index], 0, 0);
        }
        const double t = along_u ? at.y() : at.x();
        return {evaluate(line, t), s.weights.empty() ? 1 : evaluate(weight, t).x()};
    }
};

// --- approximated ---

// The knots of one parameter of the basis, and after how much it repeats (0: it does not).
struct ParameterLine {
    std::vector<double> knots;
    double period = 0;
};

ParameterLine along(const Curve& curve) {
    const auto* spline = std::get_if<BSplineCurve>(&curve);
    return {spline ? spline->knots : std::vector<double>(), period(curve)};
}

struct ParameterLines {
    using Pair = std::array<ParameterLine, 2>;

    Pair operator()(const Plane&) const { return {}; }
    Pair operator()(const Cylinder&) const { return {angle, {}}; }
    Pair operator()(const Cone&) const { return {angle, {}}; }
    Pair operator()(const Sphere&) const { return {angle, {}}; }
    Pair operator()(const Torus&) const { return {angle, angle}; }
    Pair operator()(const SharedBSplineSurface& s) const {
        return {ParameterLine{s->knots_u, s->closed_u ? s->end_u() - s->start_u() : 0},
                ParameterLine{s->knots_v, s->closed_v ? s->end_v() - s->start_v() : 0}};
    }
    Pair operator()(const Extrusion& s) const { return {along(s.curve), {}}; }
    Pair operator()(const Revolution& s) const { return {angle, along(s.curve)}; }

    ParameterLine angle{{}, 2 * pi};
};

// Appends where a piece's coordinate passes knots.
void append_crossings(const BezierPiece& piece, Eigen::Index row, const ParameterLine& line,
                      std::vector<double>& ends) {
    if (line.knots.empty()) return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Vector4d& c : piece.control_points) {
        low = std::min(low, c[row] / c.w());
        high = std::max(high, c[row] / c.w());
    }
    const auto pass = [&](double knot) {
        if (!(knot > low && knot < high)) return;
        bernstein::Coefficients c;
        for (const Eigen::Vector4d& p : piece.control_points) c.push_back(p[row] - knot * p.w());
        const auto negligible = [](const bernstein::Coefficients&, double) { return false; };
        for (const double t : bernstein::isolate(c, negligible))
            ends.push_back(piece.from + t * (piece.to - piece.from));
    };
    double before = std::nan("");
    for (const double knot : line.knots) {
        if (knot == before) continue;
        before = knot;
        if (!(line.period > 0)) {
            pass(knot);
            continue;
        }
        const double first = std::ceil((low - knot) / line.period);
        for (double turn = first; knot + turn * line.period < high; ++turn)
            pass(knot + turn * line.period);
    }
}

std::vector<SmoothPiece> smooth_pieces(const ParameterSpace& space, const BezierPiece& piece) {
    const ParameterLines::Pair lines = std::visit(ParameterLines{}, space.basis);
    std::vector<double> ends{piece.from};
    append_crossings(piece, 0, lines[0], ends);
    append_crossings(piece, 1, lines[1], ends);
    std::sort(ends.begin(), ends.end());
    // Parts narrower than this are round-off of the crossings.
    const double narrowest = 1e-12 * (piece.to - piece.from);
    std::vector<SmoothPiece> pieces;
    double from = piece.from;
    for (std::size_t i = 1; i <= ends.size(); ++i) {
        const double to = i == ends.size() ? piece.to : ends[i];
        if (!(to - from > narrowest)) continue;
        const Moving<double> middle = moving(piece, 0.5 * (from + to));
        const Point2 inside(middle.point[0], middle.point[1]);
        pieces.push_back({from, to, CurveFunction::of([&space, piece, inside](const auto& t) {
                              const auto uv = moving(piece, t).point;
                              return point_on(space, uv[0], uv[1], inside);
                          })});
        from = to;
    }
    pieces.back().to = piece.to;
    return pieces;
}

// --- where points are ---

Point3 point_at(const ParameterSpace& space, const Point2& uv) {
    const Triple<double> p = point_on(space, uv.x(), uv.y(), uv);
    return {p[0], p[1], p[2]};
}

// Nearest to a point, from a guess, by the Gauss-Newton method.
Point2 polished(const ParameterSpace& space, Point2 uv, const Point3& point) {
    constexpr int most_steps = 30;
    // Of the parameter: half the digits, the best that differences can do.
    constexpr double step = 1e-7;
    double distance_mm = (point_at(space, uv) - point).norm();
    for (int i = 0; i < most_steps; ++i) {
        Eigen::Matrix<double, 3, 2> slopes;
        for (const int k : {0, 1}) {
            const Vector2 by = step * Vector2::Unit(k);
            slopes.col(k) = (point_at(space, uv + by) - point_at(space, uv - by)) / (2 * step);
        }
        const Vector2 towards = slopes.colPivHouseholderQr().solve(point - point_at(space, uv));
        const Point2 next = uv + towards;
        const double next_mm = (point_at(space, next) - point).norm();
        if (!(next_mm < distance_mm)) break;
        uv = next;
        distance_mm = next_mm;
    }
    return uv;
}

// Places on a curve from which the nearest point is found: all around what ends or repeats.
std::vector<double> guesses_along(const Curve& curve) {
    constexpr int steps = 32;
    const bool is_endless = !(period(curve) > 0) && !std::holds_alternative<BSplineCurve>(curve);
    const Stretch all = is_endless ? Stretch{-4, 4} : whole_stretch(curve);
    std::vector<double> guesses;
    for (int i = 0; i <= steps; ++i) guesses.push_back(all.low + (all.high - all.low) * i / steps);
    return guesses;
}

struct ParametersOf {
    const ParameterSpace& space;
    Point3 point, local;

    template <class Elementary>
    Point2 operator()(const Elementary& s) const {
        return invert(Surface(s), local);
    }
    // Of either nappe, with sizes of either sign.
    Point2 operator()(const Cone& s) const {
        const Point3 p = s.frame.to_local(local);
        const double sine = std::sin(s.half_angle_rad), cosine = std::cos(s.half_angle_rad);
        const double angle = direction_angle(p.y(), p.x());
        const auto height = [&](double out) {
            return cosine * ((out - s.radius_mm) * sine + p.z() * cosine);
        };
        const double out = p.head<2>().norm();
        return nearest({{angle, height(out)}, {angle + pi, height(-out)}});
    }
    Point2 operator()(const Extrusion& s) const {
        std::vector<Point2> places;
        for (const double u : guesses_along(s.curve))
            places.push_back(polished(space, {u, 0}, point));
        return nearest(places);
    }
    Point2 operator()(const Revolution& s) const {
        constexpr int angles = 8;
        std::vector<Point2> places;
        for (const double v : guesses_along(s.curve)) {
            for (int i = 0; i < angles; ++i)
                places.push_back(polished(space, {2 * pi * i / angles, v}, point));
        }
        return nearest(places);
    }
    Point2 nearest(const std::vector<Point2>& places) const {
        return *std::min_element(places.begin(), places.end(), [&](auto& a, auto& b) {
            return (point_at(space, a) - point).norm() < (point_at(space, b) - point).norm();
        });
    }
};

struct Pass {
    double t, distance_mm;
};

// Where the curve may pass through a point of the surface: by all the parameters that the point has, turn by turn.
std::vector<Pass> passes(const ParameterSpace& space, const Curve& curve, const Point3& point) {
    const Point3 local = space.to_space.inverse() * point;
    const Point2 uv = std::visit(ParametersOf{space, point, local}, space.basis);
    const ParameterLines::Pair lines = std::visit(ParameterLines{}, space.basis);
    const Vector2 turn(lines[0].period, lines[1].period);
    // Longer threads and denser windings are not stated by one curve.
    const bool both = turn.minCoeff() > 0;
    const int most = both ? 24 : 512;
    const int most_u = turn.x() > 0 ? most : 0, most_v = turn.y() > 0 ? most : 0;
    std::vector<Pass> result;
    for (int i = -most_u; i <= most_u; ++i) {
        for (int j = -most_v; j <= most_v; ++j) {
            const Point2 of_basis = uv + Vector2(i, j).cwiseProduct(turn);
            const Point2 in_file = (of_basis - space.shift).cwiseQuotient(space.scale);
            const double t = invert(curve, {in_file.x(), in_file.y(), 0});
            const Point2 foot = space.of_basis(evaluate(curve, t).head<2>());
            result.push_back({t, (point_at(space, foot) - point).norm()});
        }
    }
    return result;
}

}  // namespace

std::optional<DirectedCurve> iso_line(const ParameterSpace& space, const Line& line) {
    const Vector2 along = line.direction.head<2>().cwiseProduct(space.scale).normalized();
    const Point2 at = space.of_basis(line.origin.head<2>());
    if (const auto* plane = std::get_if<Plane>(&space.basis)) {
        const Line slope{evaluate(Surface(*plane), at),
                         along.x() * plane->frame.x + along.y() * plane->frame.y};
        return DirectedCurve{transformed(slope, space.to_space), true};
    }
    const bool along_u = std::abs(along.y()) <= angular_resolution_rad;
    if (!along_u && std::abs(along.x()) > angular_resolution_rad) return std::nullopt;
    const std::optional<Curve> curve =
        std::visit(IsoLine{at, along_u, space.offset_mm}, space.basis);
    if (!curve) return std::nullopt;
    return DirectedCurve{transformed(*curve, space.to_space),
                         (along_u ? along.x() : along.y()) > 0};
}

std::optional<BSplineCurve> lifted(const ParameterSpace& space, const BSplineCurve& curve) {
    BSplineCurve of_basis = curve;
    for (Point3& p : of_basis.control_points) p.head<2>() = space.of_basis(p.head<2>());
    std::vector<SmoothPiece> pieces;
    for (const BezierPiece& piece :
         bezier_pieces(of_basis, of_basis.domain_start(), of_basis.domain_end())) {
        for (SmoothPiece& smooth : smooth_pieces(space, piece)) pieces.push_back(std::move(smooth));
    }
    return approximated(pieces, lifted_accuracy_mm);
}

std::optional<Stretch> stretch_between(const ParameterSpace& space, const Curve& curve,
                                       const Ends& ends, double closeness_mm) {
    const auto choose = [&](std::vector<Pass> all, const auto& rank) {
        const auto nearest = std::min_element(
            all.begin(), all.end(), [](auto& a, auto& b) { return a.distance_mm < b.distance_mm; });
        const double allowed_mm = std::max(closeness_mm, nearest->distance_mm);
        std::erase_if(all, [&](const Pass& p) {
            return p.distance_mm > allowed_mm || !std::isfinite(rank(p));
        });
        const auto best = std::min_element(all.begin(), all.end(),
                                           [&](auto& a, auto& b) { return rank(a) < rank(b); });
        return best == all.end() ? std::optional<double>() : std::optional(best->t);
    };
    const std::optional<double> start =
        choose(passes(space, curve, ends.start), [](const Pass& p) { return std::abs(p.t); });
    if (!start) return std::nullopt;
    // A pass this close to the start is the start itself.
    const double same = 1e-9 * std::max(1.0, std::abs(*start));
    const std::optional<double> end = choose(passes(space, curve, ends.end), [&](const Pass& p) {
        const double ahead = ends.same_sense ? p.t - *start : *start - p.t;
        return ahead > same ? ahead : std::numeric_limits<double>::infinity();
    });
    if (!end) return std::nullopt;
    return Stretch{std::min(*start, *end), std::max(*start, *end)};
}

}  // namespace lyr::importer
