// Surfaces: elementary ones by a placement and one or two sizes each, others by what they refer to.

#include "parser/import/surfaces.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "kernel/geometry/tolerance.h"
#include "parser/import/bspline.h"
#include "parser/import/offset.h"
#include "parser/import/placement.h"
#include "parser/import/swept.h"

namespace lyr::importer {

namespace {

struct Sized {
    Frame frame;
    double first, second;  // as stated
};

Result<Sized> read_sized(const File& file, InstanceIndex instance, std::size_t sizes,
                         std::size_t attributes, const Units& units) {
    Fields fields(file, instance, attributes);
    const InstanceIndex placement = fields.reference(1);
    const double first = sizes > 0 ? fields.real(2) : 0;
    const double second = sizes > 1 ? fields.real(3) : 0;
    if (!fields.ok()) return fields.error();
    if (!std::isfinite(first) || !std::isfinite(second)) {
        return file.error(instance, named(file, instance) + ": finite sizes expected");
    }
    const Result<Frame> frame = read_frame(file, instance, placement, units);
    if (!frame) return frame.error();
    return Sized{*frame, first, second};
}

Frame turned_around(Frame frame) {
    frame.z = -frame.z;
    frame.y = -frame.y;
    return frame;
}

Result<StatedSurface> read_cone(const File& file, InstanceIndex instance, const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 2, 4, units);
    if (!sized) return sized.error();
    const double half_angle_rad = sized->second * units.angle_rad;
    if (!(std::abs(half_angle_rad) < std::numbers::pi / 2 - angular_resolution_rad)) {
        return file.error(
            instance, named(file, instance) + ": a semi-angle below 90 degrees expected, found " +
                          std::to_string(std::abs(half_angle_rad) * 180 / std::numbers::pi) +
                          " in the angle unit of its representation");
    }
    const auto cone = upright_cone({sized->frame, sized->first * units.length_mm, half_angle_rad});
    if (!cone) {
        return file.error(instance,
                          named(file, instance) + ": a cone with neither radius nor semi-angle");
    }
    return StatedSurface{*cone};
}

Result<StatedSurface> read_torus(const File& file, InstanceIndex instance, bool is_degenerate,
                                 const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 2, is_degenerate ? 5 : 4, units);
    if (!sized) return sized.error();
    if (!(sized->first > 0 && sized->second > 0)) {
        return file.error(instance, named(file, instance) + ": positive radii expected");
    }
    Torus torus{sized->frame, sized->first * units.length_mm, sized->second * units.length_mm};
    if (!is_degenerate || torus.minor_mm <= torus.major_mm) return StatedSurface{torus};
    Fields fields(file, instance, 5);
    torus.inner_sheet = !fields.boolean(4);
    if (!fields.ok()) return fields.error();
    // d/du x d/dv turns where the tube has crossed the axis.
    return StatedSurface{torus, !torus.inner_sheet, true};
}

Result<StatedSurface> read_round(const File& file, InstanceIndex instance, bool is_sphere,
                                 const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 1, 3, units);
    if (!sized) return sized.error();
    if (!(sized->first > 0))
        return file.error(instance, named(file, instance) + ": a positive radius expected");
    const double radius_mm = sized->first * units.length_mm;
    if (is_sphere) return StatedSurface{Sphere{sized->frame, radius_mm}};
    return StatedSurface{Cylinder{sized->frame, radius_mm}};
}

Result<StatedSurface> read_trimmed(const File& file, InstanceIndex instance, const Units& units,
                                   const Boundary& boundary, part21::Trail& trail) {
    // name, basis_surface, u1, u2, v1, v2, usense, vsense
    Fields fields(file, instance, 8);
    const InstanceIndex basis = fields.reference(1);
    const bool usense = fields.boolean(6), vsense = fields.boolean(7);
    if (!fields.ok()) return fields.error();
    Result<StatedSurface> surface = read_surface(file, instance, basis, units, boundary, trail);
    if (surface && usense != vsense) surface->same_sense = !surface->same_sense;
    return surface;
}

Result<StatedSurface> read_basis(const File& file, InstanceIndex instance, std::size_t attributes,
                                 const Units& units, const Boundary& boundary,
                                 part21::Trail& trail) {
    Fields fields(file, instance, attributes);
    const InstanceIndex basis = fields.reference(1);
    if (!fields.ok()) return fields.error();
    return read_surface(file, instance, basis, units, boundary, trail);
}

Result<StatedSurface> read_replica(const File& file, InstanceIndex instance, const Units& units,
                                   const Boundary& boundary, part21::Trail& trail) {
    Fields fields(file, instance, 3);
    const InstanceIndex parent = fields.reference(1), transformation = fields.reference(2);
    if (!fields.ok()) return fields.error();
    const Result<Eigen::Affine3d> to = read_transform(file, instance, transformation, units);
    if (!to) return to.error();
    const Boundary boundary_of_parent = [&] {
        std::vector<Point3> points = boundary();
        for (Point3& point : points) point = to->inverse() * point;
        return points;
    };
    Result<StatedSurface> surface =
        read_surface(file, instance, parent, units, boundary_of_parent, trail);
    if (!surface) return surface;
    surface->surface = transformed(surface->surface, *to);
    // The kernel mirrors normals with points, parameters turn d/du x d/dv against that.
    if (to->linear().determinant() < 0) surface->same_sense = !surface->same_sense;
    return surface;
}

}  // namespace

Result<StatedSurface> read_surface(const File& file, InstanceIndex user, InstanceIndex surface,
                                   const Units& units, const Boundary& boundary,
                                   part21::Trail& trail) {
    const auto step = trail.enter(surface);
    if (!step) return step.error();
    const std::string_view type = keyword(file, surface);
    if (type == "CYLINDRICAL_SURFACE") return read_round(file, surface, false, units);
    if (type == "SPHERICAL_SURFACE") return read_round(file, surface, true, units);
    if (type == "CONICAL_SURFACE") return read_cone(file, surface, units);
    if (type == "TOROIDAL_SURFACE") return read_torus(file, surface, false, units);
    if (type == "DEGENERATE_TOROIDAL_SURFACE") return read_torus(file, surface, true, units);
    if (type == "PLANE") {
        const Result<Sized> sized = read_sized(file, surface, 0, 2, units);
        if (!sized) return sized.error();
        return StatedSurface{Plane{sized->frame}};
    }
    if (is_bspline_surface(file, surface)) {
        Result<BSplineSurface> spline = read_bspline_surface(file, surface, units);
        if (!spline) return spline.error();
        return stated(std::move(*spline));
    }
    if (type == "SURFACE_OF_LINEAR_EXTRUSION")
        return read_extrusion(file, surface, units, boundary, trail);
    if (type == "SURFACE_OF_REVOLUTION")
        return read_revolution(file, surface, units, boundary, trail);
    if (type == "RECTANGULAR_TRIMMED_SURFACE")
        return read_trimmed(file, surface, units, boundary, trail);
    if (type == "CURVE_BOUNDED_SURFACE")
        return read_basis(file, surface, 4, units, boundary, trail);
    if (type == "SURFACE_REPLICA") return read_replica(file, surface, units, boundary, trail);
    if (type == "OFFSET_SURFACE") return read_offset(file, surface, units, boundary, trail);
    if (!type.empty() && type.find("SURFACE") == std::string_view::npos) {
        return unexpected(file, user, "a surface", surface);
    }
    return unsupported(file, surface, "the surface of " + named(file, user));
}

StatedSurface stated(BSplineSurface surface) {
    if (const std::optional<Plane> plane = as_plane(surface)) return {*plane};
    return {std::make_shared<const BSplineSurface>(std::move(surface))};
}

Cone other_nappe(const Cone& cone) {
    Cone other = cone;
    other.frame = turned_around(cone.frame);
    other.frame.origin =
        cone.frame.origin - cone.radius_mm / std::tan(cone.half_angle_rad) * cone.frame.z;
    other.radius_mm = 0;
    return other;
}

std::optional<Surface> upright_cone(Cone cone) {
    if (cone.half_angle_rad < 0) {
        cone.frame = turned_around(cone.frame);
        cone.half_angle_rad = -cone.half_angle_rad;
    }
    if (cone.half_angle_rad < angular_resolution_rad) {
        if (cone.radius_mm > 0) return Cylinder{cone.frame, cone.radius_mm};
        return std::nullopt;
    }
    if (cone.radius_mm < 0) {
        cone.frame.origin -= cone.radius_mm / std::tan(cone.half_angle_rad) * cone.frame.z;
        cone.radius_mm = 0;
    }
    return cone;
}

}  // namespace lyr::importer
