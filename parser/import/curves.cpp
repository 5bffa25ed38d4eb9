// Curves: elementary ones by their placement and sizes, curves on surfaces and trimmed curves by what they refer to.

#include "parser/import/curves.h"

#include <cmath>

#include "kernel/geometry/tolerance.h"
#include "parser/import/bounded_curve.h"
#include "parser/import/bspline.h"
#include "parser/import/offset.h"
#include "parser/import/pcurve.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

Result<Curve> read_line(const File& file, InstanceIndex instance, const Units& units) {
    Fields fields(file, instance, 3);
    const InstanceIndex point = fields.reference(1);
    const InstanceIndex vector = fields.reference(2);
    if (!fields.ok()) return fields.error();
    const Result<Point3> origin = read_point(file, instance, point, units);
    if (!origin) return origin.error();
    if (keyword(file, vector) != "VECTOR") return unexpected(file, instance, "VECTOR", vector);
    Fields vector_fields(file, vector, 3);
    const InstanceIndex orientation = vector_fields.reference(1);
    const double magnitude = vector_fields.real(2);
    if (!vector_fields.ok()) return vector_fields.error();
    const Result<Vector3> direction = read_direction(file, vector, orientation, units);
    if (!direction) return direction.error();
    return Curve(Line{*origin, magnitude < 0 ? Vector3(-*direction) : *direction});
}

// A placement and lengths: what all conics consist of.
struct Conic {
    Frame frame;
    double first_mm, second_mm;
};

Result<Conic> read_conic(const File& file, InstanceIndex instance, std::size_t lengths,
                         const Units& units) {
    Fields fields(file, instance, 2 + lengths);
    const InstanceIndex placement = fields.reference(1);
    const double first = fields.real(2);
    const double second = lengths > 1 ? fields.real(3) : first;
    if (!fields.ok()) return fields.error();
    if (!(first > 0 && second > 0 && std::isfinite(first) && std::isfinite(second))) {
        return file.error(
            instance, named(file, instance) + ": radius, axes and focal distance must be positive");
    }
    const Result<Frame> frame = read_frame(file, instance, placement, units);
    if (!frame) return frame.error();
    return Conic{*frame, units.length_mm * first, units.length_mm * second};
}

Result<Curve> read_elementary(const File& file, InstanceIndex instance, std::string_view type,
                              const Units& units) {
    if (type == "LINE") return read_line(file, instance, units);
    const bool one_length = type == "CIRCLE" || type == "PARABOLA";
    const Result<Conic> conic = read_conic(file, instance, one_length ? 1 : 2, units);
    if (!conic) return conic.error();
    if (type == "CIRCLE") return Curve(Circle{conic->frame, conic->first_mm});
    if (type == "ELLIPSE") return Curve(Ellipse{conic->frame, conic->first_mm, conic->second_mm});
    if (type == "PARABOLA") return Curve(Parabola{conic->frame, conic->first_mm});
    return Curve(Hyperbola{conic->frame, conic->first_mm, conic->second_mm});
}

bool is_elementary(std::string_view type) {
    return type == "LINE" || type == "CIRCLE" || type == "ELLIPSE" || type == "PARABOLA" ||
           type == "HYPERBOLA";
}

bool is_on_surface(std::string_view type) {
    return type == "SURFACE_CURVE" || type == "SEAM_CURVE" || type == "INTERSECTION_CURVE" ||
           type == "BOUNDED_SURFACE_CURVE";
}

Result<DirectedCurve> directed(Result<Curve> curve) {
    if (!curve) return curve.error();
    return DirectedCurve{std::move(*curve), true};
}

Result<DirectedCurve> directed(Result<BSplineCurve> curve) {
    if (!curve) return curve.error();
    return DirectedCurve{std::move(*curve), true};
}

Result<DirectedCurve> read_trimmed(const File& file, InstanceIndex instance, const Units& units,
                                   part21::Trail& trail, std::optional<Ends> ends) {
    Fields fields(file, instance, 6);
    const InstanceIndex basis = fields.reference(1);
    const bool agrees = fields.boolean(4);
    if (!fields.ok()) return fields.error();
    if (ends && !agrees) ends->same_sense = !ends->same_sense;
    Result<DirectedCurve> curve = read_curve(file, instance, basis, units, trail, ends);
    if (curve && !agrees) curve->same_sense = !curve->same_sense;
    return curve;
}

Result<DirectedCurve> read_on_surface(const File& file, InstanceIndex instance,
                                      std::string_view type, const Units& units,
                                      part21::Trail& trail, const std::optional<Ends>& ends) {
    if (!file.is_complex(instance)) {
        Fields fields(file, instance, 4);
        const InstanceIndex in_space = fields.reference(1);
        if (!fields.ok()) return fields.error();
        return read_curve(file, instance, in_space, units, trail, ends);
    }
    Attributes a(file, instance, type, 1, 3);
    const InstanceIndex in_space = a.fields.reference(a.first);
    if (!a.fields.ok()) return a.fields.error();
    return read_curve(file, instance, in_space, units, trail, ends);
}

Result<DirectedCurve> read_replica(const File& file, InstanceIndex instance, const Units& units,
                                   part21::Trail& trail, std::optional<Ends> ends) {
    Fields fields(file, instance, 3);
    const InstanceIndex parent = fields.reference(1), transformation = fields.reference(2);
    if (!fields.ok()) return fields.error();
    const Result<Eigen::Affine3d> to = read_transform(file, instance, transformation, units);
    if (!to) return to.error();
    if (ends) ends = Ends{to->inverse() * ends->start, to->inverse() * ends->end, ends->same_sense};
    Result<DirectedCurve> curve = read_curve(file, instance, parent, units, trail, ends);
    if (curve) curve->curve = transformed(curve->curve, *to);
    return curve;
}

}  // namespace

Result<DirectedCurve> read_curve(const File& file, InstanceIndex user, InstanceIndex curve,
                                 const Units& units, part21::Trail& trail,
                                 const std::optional<Ends>& ends) {
    const auto step = trail.enter(curve);
    if (!step) return step.error();
    const std::string_view type = keyword(file, curve);
    if (is_elementary(type)) return directed(read_elementary(file, curve, type, units));
    if (is_bspline_curve(file, curve)) return directed(read_bspline_curve(file, curve, units));
    if (is_on_surface(type) || file.is(curve, "SURFACE_CURVE")) {
        return read_on_surface(file, curve, "SURFACE_CURVE", units, trail, ends);
    }
    if (type == "TRIMMED_CURVE") return read_trimmed(file, curve, units, trail, ends);
    if (type == "POLYLINE") return directed(read_polyline(file, curve, units));
    if (is_composite(type)) return directed(read_composite(file, curve, units, trail));
    if (type == "OFFSET_CURVE_3D" || (type == "OFFSET_CURVE_2D" && units.dimension == 2))
        return read_offset_curve(file, curve, units, trail, ends);
    if (type == "BOUNDED_PCURVE" || file.is(curve, "PCURVE"))
        return read_pcurve(file, curve, units, trail, ends);
    if (type == "CURVE_REPLICA") return read_replica(file, curve, units, trail, ends);
    const bool is_curve =
        type.empty() || type.find("CURVE") != std::string_view::npos || type == "CLOTHOID";
    if (!is_curve) return unexpected(file, user, "a curve", curve);
    return unsupported(file, curve, "a curve of " + named(file, user));
}

Curve simplified(const Curve& curve) {
    const auto* spline = std::get_if<BSplineCurve>(&curve);
    if (spline == nullptr || spline->control_points.size() != 2) return curve;
    const Vector3 along = spline->control_points[1] - spline->control_points[0];
    if (along.norm() <= resolution_mm) return curve;
    return Line{spline->control_points[0], along.normalized()};
}

}  // namespace lyr::importer
