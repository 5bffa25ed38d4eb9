// Surfaces: a placement and one or two sizes each.

#include "parser/import/surfaces.h"

#include <cmath>
#include <numbers>

#include "kernel/geometry/tolerance.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

struct Sized {
    Frame frame;
    double first, second;  // as stated
};

Result<Sized> read_sized(const File& file, InstanceIndex instance, std::size_t sizes,
                         const Units& units) {
    Fields fields(file, instance, 2 + sizes);
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

Result<Surface> read_cone(const File& file, InstanceIndex instance, const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 2, units);
    if (!sized) return sized.error();
    Cone cone{sized->frame, sized->first * units.length_mm, sized->second * units.angle_rad};
    if (cone.half_angle_rad < 0) {
        cone.frame = turned_around(cone.frame);
        cone.half_angle_rad = -cone.half_angle_rad;
    }
    if (!(cone.half_angle_rad < std::numbers::pi / 2 - angular_resolution_rad)) {
        return file.error(
            instance, named(file, instance) + ": a semi-angle below 90 degrees expected, found " +
                          std::to_string(cone.half_angle_rad * 180 / std::numbers::pi) +
                          " in the angle unit of its representation");
    }
    if (cone.half_angle_rad < angular_resolution_rad) {
        if (cone.radius_mm > 0) return Surface(Cylinder{cone.frame, cone.radius_mm});
        return file.error(instance,
                          named(file, instance) + ": a cone with neither radius nor semi-angle");
    }
    if (cone.radius_mm < 0) {
        cone.frame.origin -= cone.radius_mm / std::tan(cone.half_angle_rad) * cone.frame.z;
        cone.radius_mm = 0;
    }
    return Surface(cone);
}

Result<Surface> read_torus(const File& file, InstanceIndex instance, const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 2, units);
    if (!sized) return sized.error();
    if (!(sized->first > 0 && sized->second > 0)) {
        return file.error(instance, named(file, instance) + ": positive radii expected");
    }
    return Surface(
        Torus{sized->frame, sized->first * units.length_mm, sized->second * units.length_mm});
}

Result<Surface> read_round(const File& file, InstanceIndex instance, bool is_sphere,
                           const Units& units) {
    const Result<Sized> sized = read_sized(file, instance, 1, units);
    if (!sized) return sized.error();
    if (!(sized->first > 0))
        return file.error(instance, named(file, instance) + ": a positive radius expected");
    const double radius_mm = sized->first * units.length_mm;
    if (is_sphere) return Surface(Sphere{sized->frame, radius_mm});
    return Surface(Cylinder{sized->frame, radius_mm});
}

}  // namespace

Result<Surface> read_surface(const File& file, InstanceIndex user, InstanceIndex surface,
                             const Units& units) {
    const std::string_view type = keyword(file, surface);
    if (type == "CYLINDRICAL_SURFACE") return read_round(file, surface, false, units);
    if (type == "SPHERICAL_SURFACE") return read_round(file, surface, true, units);
    if (type == "CONICAL_SURFACE") return read_cone(file, surface, units);
    if (type == "TOROIDAL_SURFACE") return read_torus(file, surface, units);
    if (type == "PLANE") {
        const Result<Sized> sized = read_sized(file, surface, 0, units);
        if (!sized) return sized.error();
        return Surface(Plane{sized->frame});
    }
    if (!type.empty() && type.find("SURFACE") == std::string_view::npos) {
        return unexpected(file, user, "a surface", surface);
    }
    return unsupported(file, surface, "the surface of " + named(file, user));
}

Cone other_nappe(const Cone& cone) {
    Cone other = cone;
    other.frame = turned_around(cone.frame);
    other.frame.origin =
        cone.frame.origin - cone.radius_mm / std::tan(cone.half_angle_rad) * cone.frame.z;
    other.radius_mm = 0;
    return other;
}

}  // namespace lyr::importer
