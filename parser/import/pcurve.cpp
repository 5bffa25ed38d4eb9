// Curves in parameters are read like curves in space, with z = 0, and taken through their surface.

#include "parser/import/pcurve.h"

#include <algorithm>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_surface.h"
#include "parser/import/bounded_curve.h"
#include "parser/import/curve_on_surface.h"

namespace lyr::importer {

namespace {

// The curve in parameters, and its ends if it is stated with any.
struct FlatCurve {
    DirectedCurve directed;
    std::optional<Stretch> stretch;
};

Result<FlatCurve> read_flat(const File& file, InstanceIndex representation, const Units& units,
                            part21::Trail& trail) {
    // name, items, context_of_items
    Fields fields(file, representation, 3);
    const std::vector<InstanceIndex> curves = fields.references(1);
    if (!fields.ok()) return fields.error();
    if (curves.size() != 1)
        return file.error(representation, named(file, representation) + ": one curve expected");
    const Units parameters{.length_mm = 1, .angle_rad = units.angle_rad, .dimension = 2};
    Result<DirectedCurve> flat =
        read_curve(file, representation, curves.front(), parameters, trail);
    if (!flat) return flat.error();
    flat->curve = simplified(flat->curve);
    const bool has_ends =
        std::holds_alternative<BSplineCurve>(flat->curve) || period(flat->curve) > 0;
    if (has_ends) return FlatCurve{*flat, whole_stretch(flat->curve)};
    if (keyword(file, curves.front()) != "TRIMMED_CURVE") return FlatCurve{*flat, std::nullopt};
    const Result<BoundedCurve> trimmed =
        read_bounded_curve(file, representation, curves.front(), parameters, trail);
    if (!trimmed) return trimmed.error();
    return FlatCurve{
        *flat, Stretch{std::min(trimmed->from, trimmed->to), std::max(trimmed->from, trimmed->to)}};
}

Curve on_plane(const ParameterSpace& space, const Plane& plane, const Curve& curve) {
    Eigen::Affine3d in_file = Eigen::Affine3d::Identity(), on_plane = in_file;
    in_file.linear().diagonal() << space.scale.x(), space.scale.y(), space.scale.x();
    in_file.translation() << space.shift.x(), space.shift.y(), 0;
    on_plane.linear() << plane.frame.x, plane.frame.y, plane.frame.z;
    on_plane.translation() = plane.frame.origin;
    return transformed(curve, space.to_space * on_plane * in_file);
}

std::optional<DirectedCurve> in_space(const ParameterSpace& space, const FlatCurve& flat,
                                      std::optional<Ends> ends, double closeness_mm) {
    const auto& [curve, same_sense] = flat.directed;
    if (const auto* plane = std::get_if<Plane>(&space.basis))
        return DirectedCurve{on_plane(space, *plane, curve), same_sense};
    const auto* line = std::get_if<Line>(&curve);
    if (std::optional<DirectedCurve> iso = line ? iso_line(space, *line) : std::nullopt) {
        iso->same_sense = iso->same_sense == same_sense;
        return iso;
    }
    std::optional<Stretch> stretch = flat.stretch;
    const bool is_endless = !std::holds_alternative<BSplineCurve>(curve) && !(period(curve) > 0);
    if (is_endless && ends) {
        ends->same_sense = ends->same_sense == same_sense;
        if (const auto found = stretch_between(space, curve, *ends, closeness_mm)) stretch = found;
    }
    if (!stretch) return std::nullopt;
    std::optional<BSplineCurve> spline =
        lifted(space, rational(curve, stretch->low, stretch->high));
    if (!spline) return std::nullopt;
    return DirectedCurve{std::move(*spline), same_sense};
}

// How far the curve is from where an edge ends; nothing is known without one.
double misfit_mm(const std::optional<DirectedCurve>& curve, const std::optional<Ends>& ends) {
    if (!curve) return std::numeric_limits<double>::infinity();
    if (!ends) return 0;
    const auto off = [&](const Point3& p) {
        return (evaluate(curve->curve, invert(curve->curve, p)) - p).norm();
    };
    return std::max(off(ends->start), off(ends->end));
}

}  // namespace

Result<DirectedCurve> read_pcurve(const File& file, InstanceIndex instance, const Units& units,
                                  part21::Trail& trail, const std::optional<Ends>& ends) {
    // basis_surface, reference_to_curve
    Attributes a(file, instance, "PCURVE", 1, 2);
    const InstanceIndex basis = a.fields.reference(a.first),
                        representation = a.fields.reference(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    if (keyword(file, representation) != "DEFINITIONAL_REPRESENTATION")
        return unexpected(file, instance, "DEFINITIONAL_REPRESENTATION", representation);
    const Result<FlatCurve> flat = read_flat(file, representation, units, trail);
    if (!flat) return flat.error();
    const double closeness_mm = std::max(resolution_mm, units.uncertainty_mm);
    std::optional<DirectedCurve> best;
    for (const bool trims_from_zero : {true, false}) {
        const Result<ParameterSpace> space =
            read_parameter_space(file, instance, basis, units, trims_from_zero, trail);
        if (!space) return space.error();
        std::optional<DirectedCurve> curve = in_space(*space, *flat, ends, closeness_mm);
        if (misfit_mm(curve, ends) < misfit_mm(best, ends)) best = std::move(curve);
        if (misfit_mm(best, ends) <= closeness_mm) break;
    }
    if (!best) return unsupported(file, instance, "a curve without ends in parameters");
    return *best;
}

}  // namespace lyr::importer
