// Elementary surfaces as stated, swept ones by their curve, the others by what they do to their basis.

#include "parser/import/parameter_space.h"

#include <cmath>
#include <memory>

#include "kernel/geometry/bspline_offset.h"
#include "parser/import/bounded_curve.h"
#include "parser/import/bspline.h"
#include "parser/import/curves.h"
#include "parser/import/offset.h"
#include "parser/import/placement.h"
#include "parser/import/surfaces.h"
#include "parser/import/swept.h"

namespace lyr::importer {

namespace {

// The offset of an elementary surface has the same parameters, but for a shift along a cone. Beyond an axis or centre
// the radius is negative.
struct Resize {
    ParameterSpace& space;

    bool operator()(Plane& s) const {
        s.frame.origin += space.offset_mm * s.frame.z;
        return true;
    }
    bool operator()(Cylinder& s) const { return add(s.radius_mm); }
    bool operator()(Sphere& s) const { return add(s.radius_mm); }
    bool operator()(Torus& s) const { return add(s.minor_mm); }
    bool operator()(Cone& s) const {
        s.radius_mm += space.offset_mm / std::cos(s.half_angle_rad);
        space.shift.y() -= space.offset_mm * std::sin(s.half_angle_rad);
        return true;
    }
    template <class Other>
    bool operator()(const Other&) const {
        return false;
    }

    bool add(double& radius_mm) const {
        radius_mm += space.offset_mm;
        return true;
    }
};

class Reader {
public:
    Reader(const File& file, const Units& units, bool trims_from_zero, part21::Trail& trail)
        : file_(file), units_(units), trims_from_zero_(trims_from_zero), trail_(trail) {}

    Result<ParameterSpace> read(InstanceIndex user, InstanceIndex surface) {
        const std::string_view type = keyword(file_, surface);
        if (is_elementary(type)) return elementary(user, surface, type);
        const auto step = trail_.enter(surface);
        if (!step) return step.error();
        if (is_bspline_surface(file_, surface)) {
            Result<BSplineSurface> spline = read_bspline_surface(file_, surface, units_);
            if (!spline) return spline.error();
            return ParameterSpace{std::make_shared<const BSplineSurface>(std::move(*spline))};
        }
        if (type == "CONICAL_SURFACE") return cone(surface);
        if (type == "SURFACE_OF_LINEAR_EXTRUSION") return extrusion(surface);
        if (type == "SURFACE_OF_REVOLUTION") return revolution(surface);
        if (type == "RECTANGULAR_TRIMMED_SURFACE") return trimmed(surface);
        if (type == "SURFACE_REPLICA") return replica(surface);
        if (type == "OFFSET_SURFACE") return offset_surface(surface);
        if (type == "CURVE_BOUNDED_SURFACE") {
            Fields fields(file_, surface, 4);
            const InstanceIndex basis = fields.reference(1);
            if (!fields.ok()) return fields.error();
            return read(surface, basis);
        }
        return unsupported(file_, surface, "the surface of " + named(file_, user));
    }

private:
    static bool is_elementary(std::string_view type) {
        return type == "PLANE" || type == "CYLINDRICAL_SURFACE" || type == "SPHERICAL_SURFACE" ||
               type == "TOROIDAL_SURFACE" || type == "DEGENERATE_TOROIDAL_SURFACE";
    }

    Result<ParameterSpace> elementary(InstanceIndex user, InstanceIndex surface,
                                      std::string_view type) {
        const bool is_plane = type == "PLANE", is_cylinder = type == "CYLINDRICAL_SURFACE";
        const bool is_round = !is_plane && !is_cylinder;
        const Result<StatedSurface> stated = read_surface(
            file_, user, surface, units_, [] { return std::vector<Point3>(); }, trail_);
        if (!stated) return stated.error();
        const double length = units_.length_mm, angle = units_.angle_rad;
        ParameterSpace space{Plane{}, {is_plane ? length : angle, is_round ? angle : length}};
        std::visit([&](const auto& s) { space.basis = s; }, stated->surface);
        return space;
    }

    // As stated, whatever the signs: the kernel's cone, which is turned upright, counts otherwise.
    Result<ParameterSpace> cone(InstanceIndex surface) {
        Fields fields(file_, surface, 4);
        const InstanceIndex placement = fields.reference(1);
        const double radius = fields.real(2), half_angle = fields.real(3);
        if (!fields.ok()) return fields.error();
        const Result<Frame> frame = read_frame(file_, surface, placement, units_);
        if (!frame) return frame.error();
        return ParameterSpace{
            Cone{*frame, radius * units_.length_mm, half_angle * units_.angle_rad},
            {units_.angle_rad, units_.length_mm}};
    }

    // The curve of a sweep, and how long a step of one along it is.
    struct Swept {
        Curve curve;
        double scale;
    };
    Result<Swept> swept(InstanceIndex user, InstanceIndex instance) {
        const Result<DirectedCurve> curve = read_curve(file_, user, instance, units_, trail_);
        if (!curve) return curve.error();
        const Result<std::optional<double>> scale =
            parameter_scale(file_, instance, *curve, units_);
        if (!scale) return scale.error();
        if (!*scale) {
            return unsupported(file_, instance,
                               "the parameters of the curve of " + named(file_, user));
        }
        return Swept{curve->curve, **scale};
    }

    Result<ParameterSpace> extrusion(InstanceIndex surface) {
        const Result<StatedExtrusion> stated = read_stated_extrusion(file_, surface, units_);
        if (!stated) return stated.error();
        const Result<Swept> of = swept(surface, stated->swept);
        if (!of) return of.error();
        return ParameterSpace{Extrusion{of->curve, stated->direction},
                              {of->scale, stated->length_mm}};
    }

    Result<ParameterSpace> revolution(InstanceIndex surface) {
        const Result<StatedRevolution> stated = read_stated_revolution(file_, surface, units_);
        if (!stated) return stated.error();
        const Result<Swept> of = swept(surface, stated->swept);
        if (!of) return of.error();
        return ParameterSpace{Revolution{of->curve, stated->axis}, {units_.angle_rad, of->scale}};
    }

    Result<ParameterSpace> trimmed(InstanceIndex surface) {
        // name, basis_surface, u1, u2, v1, v2, usense, vsense
        Fields fields(file_, surface, 8);
        const InstanceIndex basis = fields.reference(1);
        const Point2 begin(fields.real(2), fields.real(4));
        const Vector2 sense(fields.boolean(6) ? 1 : -1, fields.boolean(7) ? 1 : -1);
        if (!fields.ok()) return fields.error();
        Result<ParameterSpace> space = read(surface, basis);
        if (!space || !trims_from_zero_) return space;
        space->shift = space->of_basis(begin);
        space->scale = space->scale.cwiseProduct(sense);
        return space;
    }

    Result<ParameterSpace> replica(InstanceIndex surface) {
        Fields fields(file_, surface, 3);
        const InstanceIndex parent = fields.reference(1), transformation = fields.reference(2);
        if (!fields.ok()) return fields.error();
        const Result<Eigen::Affine3d> to = read_transform(file_, surface, transformation, units_);
        if (!to) return to.error();
        Result<ParameterSpace> space = read(surface, parent);
        if (space) space->to_space = *to * space->to_space;
        return space;
    }

    Result<ParameterSpace> offset_surface(InstanceIndex surface) {
        const Result<StatedOffset> stated = read_stated_offset(file_, surface, units_, trail_);
        if (!stated) return stated.error();
        Result<ParameterSpace> space = read(surface, stated->basis);
        if (!space) return space;
        // Along the normal of the file's parameters, which a mirror and a reversed parameter turn around.
        const double determinant = space->to_space.linear().determinant();
        const bool turned = (space->scale.prod() < 0) != (determinant < 0);
        const double along = stated->distance_mm / std::cbrt(std::abs(determinant));
        space->offset_mm += turned ? -along : along;
        if (std::visit(Resize{*space}, space->basis)) space->offset_mm = 0;
        const auto* spline = std::get_if<SharedBSplineSurface>(&space->basis);
        if (spline == nullptr) return space;
        auto result =
            offset(**spline, space->offset_mm, std::max(resolution_mm, units_.uncertainty_mm));
        if (const auto* failure = std::get_if<OffsetFailure>(&result))
            return offset_failed(file_, surface, stated->basis, *failure);
        space->basis =
            std::make_shared<const BSplineSurface>(std::get<BSplineSurface>(std::move(result)));
        space->offset_mm = 0;
        return space;
    }

    const File& file_;
    const Units& units_;
    bool trims_from_zero_;
    part21::Trail& trail_;
};

}  // namespace

Result<ParameterSpace> read_parameter_space(const File& file, InstanceIndex user,
                                            InstanceIndex surface, const Units& units,
                                            bool trims_from_zero, part21::Trail& trail) {
    return Reader(file, units, trims_from_zero, trail).read(user, surface);
}

}  // namespace lyr::importer
