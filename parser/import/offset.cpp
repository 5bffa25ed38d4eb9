// Offsets of elementary surfaces and curves change sizes only; one that goes through an axis or centre comes out as a
// surface that looks the other way. The others are approximated within proven bounds.

#include "parser/import/offset.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_offset.h"
#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/placement.h"
#include "parser/import/profile.h"
#include "parser/import/surface_functions.h"

namespace lyr::importer {

namespace {

// By a distance along normal(); nothing where nothing is left, or where the kind of surface has no elementary offset.
struct Offset {
    StatedSurface stated;
    double distance_mm;

    std::optional<StatedSurface> operator()(Plane s) const {
        s.frame.origin += distance_mm * s.frame.z;
        return with(s);
    }
    std::optional<StatedSurface> operator()(const Cylinder& s) const {
        return resized(s, &Cylinder::radius_mm);
    }
    std::optional<StatedSurface> operator()(const Sphere& s) const {
        return resized(s, &Sphere::radius_mm);
    }
    std::optional<StatedSurface> operator()(const Torus& s) const {
        return resized(s, &Torus::minor_mm);
    }
    // Moved along the axis; which of its nappes is meant, the face's loops decide.
    std::optional<StatedSurface> operator()(Cone s) const {
        s.radius_mm += distance_mm / std::cos(s.half_angle_rad);
        const std::optional<Surface> cone = upright_cone(s);
        return cone ? std::optional(with(*cone)) : std::nullopt;
    }
    std::optional<StatedSurface> operator()(const SharedBSplineSurface&) const {
        return std::nullopt;
    }

    StatedSurface with(const Surface& surface) const {
        return {surface, stated.same_sense, stated.sheet_is_stated};
    }
    // What has gone beyond its axis or centre looks the other way.
    template <class T>
    std::optional<StatedSurface> resized(T s, double T::*radius_mm) const {
        s.*radius_mm += distance_mm;
        if (std::abs(s.*radius_mm) <= resolution_mm) return std::nullopt;
        const bool beyond = s.*radius_mm < 0;
        s.*radius_mm = std::abs(s.*radius_mm);
        return StatedSurface{s, stated.same_sense != beyond, stated.sheet_is_stated};
    }
};

// What the boundary of an offset needs of the basis, which is that far away.
Boundary reaching(const Boundary& boundary, double distance_mm) {
    return [=] {
        std::vector<Point3> points;
        for (const Point3& p : boundary()) {
            points.push_back(p);
            for (int i = 0; i < 3; ++i) {
                points.emplace_back(p + distance_mm * Vector3::Unit(i));
                points.emplace_back(p - distance_mm * Vector3::Unit(i));
            }
        }
        return points;
    };
}

}  // namespace

Diagnostic offset_failed(const File& file, InstanceIndex instance, InstanceIndex basis,
                         OffsetFailure failure) {
    const auto why = [&]() -> std::string {
        switch (failure) {
            case OffsetFailure::folded:
                return " has a smaller radius of curvature than that somewhere: the offset folds";
            case OffsetFailure::creased:
                return " has a crease: the offset has a gap";
            case OffsetFailure::unreachable:
                return " has no normal somewhere, or the offset all but folds";
        }
        return "";
    };
    return file.error(instance, named(file, instance) + ": " + named(file, basis) + why(),
                      ExitStatus::geometry);
}

Result<StatedOffset> read_stated_offset(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail) {
    // name, basis_surface, distance, self_intersect
    Fields fields(file, instance, 4);
    const InstanceIndex basis = fields.reference(1);
    const double distance_mm = fields.real(2) * units.length_mm;
    if (!fields.ok()) return fields.error();
    if (!std::isfinite(distance_mm))
        return file.error(instance, named(file, instance) + ": a finite distance expected");
    if (keyword(file, basis) != "OFFSET_SURFACE") return StatedOffset{basis, distance_mm};
    const auto step = trail.enter(basis);
    if (!step) return step.error();
    const Result<StatedOffset> inner = read_stated_offset(file, basis, units, trail);
    if (!inner) return inner;
    return StatedOffset{inner->basis, inner->distance_mm + distance_mm};
}

Result<StatedSurface> read_offset(const File& file, InstanceIndex instance, const Units& units,
                                  const Boundary& boundary, part21::Trail& trail) {
    const Result<StatedOffset> offset_of = read_stated_offset(file, instance, units, trail);
    if (!offset_of) return offset_of.error();
    const auto [basis, distance_mm] = *offset_of;
    const Result<StatedSurface> surface =
        read_surface(file, instance, basis, units, reaching(boundary, distance_mm), trail);
    if (!surface) return surface;
    const double along_normal_mm = surface->same_sense ? distance_mm : -distance_mm;
    if (const auto* spline = std::get_if<SharedBSplineSurface>(&surface->surface)) {
        auto result =
            offset(**spline, along_normal_mm, std::max(resolution_mm, units.uncertainty_mm));
        if (const auto* failure = std::get_if<OffsetFailure>(&result))
            return offset_failed(file, instance, basis, *failure);
        StatedSurface whole = stated(std::get<BSplineSurface>(std::move(result)));
        whole.same_sense = surface->same_sense;
        return whole;
    }
    const auto result = std::visit(Offset{*surface, along_normal_mm}, surface->surface);
    if (!result) {
        return file.error(instance,
                          named(file, instance) + ": nothing is left of " + named(file, basis));
    }
    return *result;
}

namespace {

// An offset that is a line or a circle again; beyond its centre a circle begins on the other side.
std::optional<Curve> elementary_offset(const Curve& curve, const Vector3& reference,
                                       double along_mm) {
    if (const auto* line = std::get_if<Line>(&curve)) {
        const Vector3 across = reference.cross(line->direction);
        return Line{line->origin + along_mm * across.normalized(), line->direction};
    }
    const auto* circle = std::get_if<Circle>(&curve);
    if (circle == nullptr) return std::nullopt;
    if (reference.cross(circle->frame.z).norm() > angular_resolution_rad) return std::nullopt;
    // The axis x tangent points to the centre.
    const bool inward = reference.dot(circle->frame.x.cross(circle->frame.y)) > 0;
    Circle result = *circle;
    result.radius_mm += inward ? -along_mm : along_mm;
    if (result.radius_mm < 0) {
        result.frame.x = -result.frame.x;
        result.frame.y = -result.frame.y;
        result.radius_mm = -result.radius_mm;
    }
    return result;
}

std::optional<BSplineCurve> spline_offset(const BSplineCurve& curve, const Vector3& reference,
                                          double along_mm) {
    constexpr double allowed_mm = resolution_mm / 4;
    std::vector<SmoothPiece> pieces;
    for (const BezierPiece& piece :
         bezier_pieces(curve, curve.domain_start(), curve.domain_end())) {
        const auto at = [=](const auto& t) {
            using T = std::decay_t<decltype(t)>;
            const Triple<T> fixed{T(reference.x()), T(reference.y()), T(reference.z())};
            const Moving<T> basis = moving(piece, t);
            return moved_along(basis.point, cross(fixed, basis.direction), along_mm);
        };
        pieces.push_back({piece.from, piece.to, CurveFunction::of(at)});
    }
    return approximated(pieces, allowed_mm);
}

// What is offset of a curve: all of it, or of one without ends what an edge needs.
std::optional<Stretch> offset_stretch(const Curve& curve, const std::optional<Ends>& ends) {
    const bool has_ends = std::holds_alternative<BSplineCurve>(curve) || period(curve) > 0;
    if (has_ends) return whole_stretch(curve);
    if (!ends) return std::nullopt;
    Stretch stretch;
    stretch.include(invert(curve, ends->start));
    stretch.include(invert(curve, ends->end));
    return stretch.widened();
}

}  // namespace

Result<DirectedCurve> read_offset_curve(const File& file, InstanceIndex instance,
                                        const Units& units, part21::Trail& trail,
                                        const std::optional<Ends>& ends) {
    // name, basis_curve, distance, self_intersect, ref_direction (not in parameters, where offsets go to the left)
    const bool is_flat = keyword(file, instance) == "OFFSET_CURVE_2D";
    Fields fields(file, instance, is_flat ? 4 : 5);
    const InstanceIndex basis = fields.reference(1);
    const double distance_mm = fields.real(2) * units.length_mm;
    const InstanceIndex reference = is_flat ? InstanceIndex() : fields.reference(4);
    if (!fields.ok()) return fields.error();
    if (!std::isfinite(distance_mm))
        return file.error(instance, named(file, instance) + ": a finite distance expected");
    const Result<Vector3> direction =
        is_flat ? Vector3(Vector3::UnitZ()) : read_direction(file, instance, reference, units);
    if (!direction) return direction.error();
    Result<DirectedCurve> result = read_curve(file, instance, basis, units, trail);
    if (!result) return result;
    result->curve = simplified(result->curve);
    // ISO 10303-42 on offset_curve_3d: at any point in the direction V x T, V the reference direction and T the tangent
    // of the basis curve (the wording is also in the documentation of IfcOffsetCurve3D, which is that entity). Not
    // T x V, by which some kernels define offsets of their own.
    const double along_mm = result->same_sense ? distance_mm : -distance_mm;
    const auto* line = std::get_if<Line>(&result->curve);
    if (line && direction->cross(line->direction).norm() <= angular_resolution_rad) {
        return file.error(instance, named(file, instance) + ": " + named(file, basis) +
                                        " runs along the reference direction");
    }
    if (const auto curve = elementary_offset(result->curve, *direction, along_mm)) {
        result->curve = *curve;
        const auto* circle = std::get_if<Circle>(&*curve);
        if (circle == nullptr || circle->radius_mm > resolution_mm) return result;
        return file.error(instance,
                          named(file, instance) + ": nothing is left of " + named(file, basis));
    }
    const std::optional<Stretch> stretch = offset_stretch(result->curve, ends);
    if (!stretch) return unsupported(file, instance, "an offset of " + named(file, basis));
    std::optional<BSplineCurve> spline =
        spline_offset(rational(result->curve, stretch->low, stretch->high), *direction, along_mm);
    if (!spline) {
        return file.error(instance,
                          named(file, instance) + ": " + named(file, basis) +
                              " has a corner, or runs along the reference direction somewhere",
                          ExitStatus::geometry);
    }
    result->curve = std::move(*spline);
    return result;
}

}  // namespace lyr::importer
