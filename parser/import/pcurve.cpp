// Curves in parameters are read like curves in space, with z = 0, and taken through their surface.

#include "parser/import/pcurve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/bspline.h"
#include "parser/import/placement.h"
#include "parser/import/surfaces.h"

namespace lyr::importer {

namespace {

// A surface with the parameters that the file counts in: `scale` times them are the kernel's.
struct ParameterSpace {
    Surface surface;
    Vector2 scale;
};

Result<ParameterSpace> read_space(const File& file, InstanceIndex user, InstanceIndex surface,
                                  const Units& units, part21::Trail& trail) {
    if (is_bspline_surface(file, surface)) {
        Result<BSplineSurface> spline = read_bspline_surface(file, surface, units);
        if (!spline) return spline.error();
        return ParameterSpace{std::make_shared<const BSplineSurface>(std::move(*spline)), {1, 1}};
    }
    const std::string_view type = keyword(file, surface);
    const bool is_plane = type == "PLANE";
    const bool has_axis = type == "CYLINDRICAL_SURFACE" || type == "CONICAL_SURFACE";
    const bool is_round = type == "SPHERICAL_SURFACE" || type == "TOROIDAL_SURFACE";
    if (!is_plane && !has_axis && !is_round)
        return unsupported(file, surface, "the surface of " + named(file, user));
    const Result<StatedSurface> stated = read_surface(
        file, user, surface, units, [] { return std::vector<Point3>(); }, trail);
    if (!stated) return stated.error();
    if (type == "CONICAL_SURFACE") {
        // A cone that had to be turned upright counts otherwise than the file.
        Fields fields(file, surface, 4);
        const bool upright = fields.real(2) >= 0 && fields.real(3) > 0;
        if (!fields.ok()) return fields.error();
        if (!upright) return unsupported(file, surface, "the surface of " + named(file, user));
    }
    const double length = units.length_mm, angle = units.angle_rad;
    return ParameterSpace{stated->surface, {is_plane ? length : angle, is_round ? angle : length}};
}

// --- exact ---

Curve on_plane(const Plane& plane, double scale, const Curve& curve) {
    Eigen::Affine3d to_space;
    to_space.linear() << plane.frame.x, plane.frame.y, plane.frame.z;
    to_space.linear() *= scale;
    to_space.translation() = plane.frame.origin;
    to_space.makeAffine();
    return transformed(curve, to_space);
}

// Lines of constant v (along_u) or constant u through a point given in parameters, in their sense.
struct IsoLine {
    Point2 at;
    bool along_u;

    Curve operator()(const Plane& s) const {
        return Line{evaluate(Surface(s), at), along_u ? s.frame.x : s.frame.y};
    }
    Curve operator()(const Cylinder& s) const {
        if (along_u) return parallel(s.frame, s.radius_mm, at.y());
        return Line{evaluate(Surface(s), at), s.frame.z};
    }
    Curve operator()(const Cone& s) const {
        const double slope = std::tan(s.half_angle_rad);
        if (along_u) return parallel(s.frame, s.radius_mm + at.y() * slope, at.y());
        const Vector3 along = slope * radial(s.frame) + s.frame.z;
        return Line{evaluate(Surface(s), at), along.normalized()};
    }
    Curve operator()(const Sphere& s) const {
        if (along_u) {
            return parallel(s.frame, s.radius_mm * std::cos(at.y()),
                            s.radius_mm * std::sin(at.y()));
        }
        return meridian(s.frame, s.frame.origin, s.radius_mm);
    }
    Curve operator()(const Torus& s) const {
        if (along_u) {
            return parallel(s.frame, s.major_mm + s.minor_mm * std::cos(at.y()),
                            s.minor_mm * std::sin(at.y()));
        }
        return meridian(s.frame, s.frame.origin + s.major_mm * radial(s.frame), s.minor_mm);
    }
    // Control points of the line are points of the lines across it.
    Curve operator()(const SharedBSplineSurface& s) const {
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
    Vector3 radial(const Frame& frame) const {
        return std::cos(at.x()) * frame.x + std::sin(at.x()) * frame.y;
    }
    static Curve parallel(Frame frame, double radius_mm, double height_mm) {
        frame.origin += height_mm * frame.z;
        if (radius_mm < 0) {
            frame.x = -frame.x;
            frame.y = -frame.y;
        }
        return Circle{frame, std::abs(radius_mm)};
    }
    Curve meridian(const Frame& frame, const Point3& centre, double radius_mm) const {
        const Vector3 out = radial(frame);
        return Circle{{centre, out, frame.z, out.cross(frame.z)}, radius_mm};
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

std::optional<DirectedCurve> iso_line(const ParameterSpace& space, const Line& line) {
    const Vector2 along = line.direction.head<2>().cwiseProduct(space.scale).normalized();
    const bool along_u = std::abs(along.y()) <= angular_resolution_rad;
    if (!along_u && std::abs(along.x()) > angular_resolution_rad) return std::nullopt;
    const Point2 at = line.origin.head<2>().cwiseProduct(space.scale);
    return DirectedCurve{std::visit(IsoLine{at, along_u}, space.surface),
                         (along_u ? along.x() : along.y()) > 0};
}

// --- interpolated ---

struct PointAndSlope {
    Point3 point;
    Vector3 slope;
};
using Path = std::function<PointAndSlope(double)>;

// d/du and d/dv of an elementary surface, from its point and normal: around the axis, and square to both.
Partials partials_of(const Surface& surface, const Point2& uv) {
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface))
        return partials(**spline, uv);
    struct Slopes {
        Point2 uv;
        Vector3 out(const Frame& f) const {
            return std::cos(uv.x()) * f.x + std::sin(uv.x()) * f.y;
        }
        Vector3 around(const Frame& f) const {
            return -std::sin(uv.x()) * f.x + std::cos(uv.x()) * f.y;
        }
        Vector3 up(const Frame& f) const {
            return -std::sin(uv.y()) * out(f) + std::cos(uv.y()) * f.z;
        }
        using Pair = std::pair<Vector3, Vector3>;
        Pair operator()(const Plane& s) const { return {s.frame.x, s.frame.y}; }
        Pair operator()(const Cylinder& s) const {
            return {s.radius_mm * around(s.frame), s.frame.z};
        }
        Pair operator()(const Cone& s) const {
            const double slope = std::tan(s.half_angle_rad);
            return {(s.radius_mm + uv.y() * slope) * around(s.frame),
                    slope * out(s.frame) + s.frame.z};
        }
        Pair operator()(const Sphere& s) const {
            return {s.radius_mm * std::cos(uv.y()) * around(s.frame), s.radius_mm * up(s.frame)};
        }
        Pair operator()(const Torus& s) const {
            return {(s.major_mm + s.minor_mm * std::cos(uv.y())) * around(s.frame),
                    s.minor_mm * up(s.frame)};
        }
        Pair operator()(const SharedBSplineSurface&) const { return {}; }
    };
    const auto [du, dv] = std::visit(Slopes{uv}, surface);
    return {evaluate(surface, uv), du, dv};
}

Path through(const ParameterSpace& space, const Curve& curve) {
    return [&space, curve](double t) -> PointAndSlope {
        const Vector2 step = derivative(curve, t).head<2>().cwiseProduct(space.scale);
        const Partials at =
            partials_of(space.surface, evaluate(curve, t).head<2>().cwiseProduct(space.scale));
        return {at.point, step.x() * at.du + step.y() * at.dv};
    };
}

// Appends the cubic that has the path's points and slopes at both ends; halves until it is close. The first control
// point is there already; inner ends leave theirs out, for equal slopes imply it.
void append_cubics(const Path& path, double from, double to, int depth, BSplineCurve& out) {
    const PointAndSlope a = path(from), b = path(to);
    const double third = (to - from) / 3;
    const Point3 c1 = a.point + third * a.slope, c2 = b.point - third * b.slope;
    // Half of what is promised, for the error is sampled.
    constexpr double allowed_mm = resolution_mm / 8;
    constexpr int max_depth = 16;
    double off_mm = 0;
    for (const double t : {0.25, 0.5, 0.75}) {
        const double s = 1 - t;
        const Point3 p =
            s * s * s * a.point + 3 * s * s * t * c1 + 3 * s * t * t * c2 + t * t * t * b.point;
        off_mm = std::max(off_mm, (p - path(from + t * (to - from)).point).norm());
    }
    if (off_mm > allowed_mm && depth < max_depth) {
        const double middle = 0.5 * (from + to);
        append_cubics(path, from, middle, depth + 1, out);
        out.knots.insert(out.knots.end(), 2, middle);
        append_cubics(path, middle, to, depth + 1, out);
        return;
    }
    out.control_points.push_back(c1);
    out.control_points.push_back(c2);
}

// Piece by piece between the parameters, at which the path may have corners.
BSplineCurve interpolated(const std::vector<Path>& paths, const std::vector<double>& ends) {
    BSplineCurve out{3, {ends.front()}, {paths.front()(ends.front()).point}, {}, false};
    for (std::size_t i = 0; i < paths.size(); ++i) {
        out.knots.insert(out.knots.end(), 3, ends[i]);
        append_cubics(paths[i], ends[i], ends[i + 1], 0, out);
        out.control_points.push_back(paths[i](ends[i + 1]).point);
    }
    out.knots.insert(out.knots.end(), 4, ends.back());
    const Point3 start = out.control_points.front();
    out.closed = (start - out.control_points.back()).norm() <= resolution_mm;
    return out;
}

std::optional<BSplineCurve> interpolated(const ParameterSpace& space, const Curve& curve) {
    std::vector<Path> paths;
    std::vector<double> ends;
    if (const auto* spline = std::get_if<BSplineCurve>(&curve)) {
        for (const BezierPiece& piece :
             bezier_pieces(*spline, spline->domain_start(), spline->domain_end())) {
            // A curve of its own has the slopes of its own side at its ends.
            paths.push_back(through(space, rational(curve, piece.from, piece.to)));
            ends.push_back(piece.from);
        }
        ends.push_back(spline->domain_end());
    } else if (period(curve) > 0) {
        paths.push_back(through(space, curve));
        ends = {0, period(curve)};
    } else {
        return std::nullopt;
    }
    return interpolated(paths, ends);
}

}  // namespace

Result<DirectedCurve> read_pcurve(const File& file, InstanceIndex instance, const Units& units,
                                  part21::Trail& trail) {
    // name, basis_surface, reference_to_curve
    Fields fields(file, instance, 3);
    const InstanceIndex basis = fields.reference(1), representation = fields.reference(2);
    if (!fields.ok()) return fields.error();
    if (keyword(file, representation) != "DEFINITIONAL_REPRESENTATION")
        return unexpected(file, instance, "DEFINITIONAL_REPRESENTATION", representation);
    // name, items, context_of_items
    Fields items(file, representation, 3);
    const std::vector<InstanceIndex> curves = items.references(1);
    if (!items.ok()) return items.error();
    if (curves.size() != 1)
        return file.error(representation, named(file, representation) + ": one curve expected");
    const Result<ParameterSpace> space = read_space(file, instance, basis, units, trail);
    if (!space) return space.error();
    const Units parameters{.length_mm = 1, .angle_rad = units.angle_rad, .dimension = 2};
    Result<DirectedCurve> flat =
        read_curve(file, representation, curves.front(), parameters, trail);
    if (!flat) return flat;
    const Curve curve = simplified(flat->curve);
    if (const auto* plane = std::get_if<Plane>(&space->surface)) {
        return DirectedCurve{on_plane(*plane, space->scale.x(), curve), flat->same_sense};
    }
    if (const auto* line = std::get_if<Line>(&curve)) {
        if (std::optional<DirectedCurve> iso = iso_line(*space, *line)) {
            iso->same_sense = iso->same_sense == flat->same_sense;
            return *iso;
        }
    }
    if (std::optional<BSplineCurve> spline = interpolated(*space, flat->curve)) {
        return DirectedCurve{std::move(*spline), flat->same_sense};
    }
    return unsupported(file, instance, "a sloped line or open conic in parameters");
}

}  // namespace lyr::importer
