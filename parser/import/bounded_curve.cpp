// Trims as parameters of the kernel's curves, and segments put one behind the other.

#include "parser/import/bounded_curve.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/curves.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

// One end of a trimmed curve, as far as it is stated.
struct Trim {
    InstanceIndex point;
    std::optional<double> parameter;
};

Result<Trim> read_trim(Fields& fields, std::size_t index) {
    Trim trim;
    for (const part21::Value& value : fields.list(index)) {
        if (value.is_reference()) {
            const Result<InstanceIndex> point = value.as_reference();
            if (!point) return point.error();
            trim.point = *point;
        } else {
            const Result<double> parameter = value.untyped().as_real();
            if (!parameter) return parameter.error();
            trim.parameter = *parameter;
        }
    }
    if (!fields.ok()) return fields.error();
    return trim;
}

Result<double> parameter_of(const File& file, InstanceIndex trimmed, const Trim& trim,
                            InstanceIndex basis, const DirectedCurve& curve, bool prefer_parameter,
                            const Units& units) {
    if (trim.parameter && (prefer_parameter || !trim.point.valid())) {
        const Result<std::optional<double>> scale = parameter_scale(file, basis, curve, units);
        if (!scale) return scale.error();
        if (*scale) return **scale * *trim.parameter;
    }
    if (!trim.point.valid())
        return unsupported(file, trimmed, "a trim of " + named(file, basis) + " by parameters");
    const Result<Point3> point = read_point(file, trimmed, trim.point, units);
    if (!point) return point.error();
    return invert(curve.curve, *point);
}

Result<BoundedCurve> read_trimmed(const File& file, InstanceIndex instance, const Units& units,
                                  part21::Trail& trail) {
    // name, basis_curve, trim_1, trim_2, sense_agreement, master_representation
    Fields fields(file, instance, 6);
    const InstanceIndex basis = fields.reference(1);
    const Result<Trim> first = read_trim(fields, 2);
    if (!first) return first.error();
    const Result<Trim> second = read_trim(fields, 3);
    if (!second) return second.error();
    const bool agrees = fields.boolean(4);
    const bool prefer_parameter = fields.enumeration(5) == "PARAMETER";
    if (!fields.ok()) return fields.error();
    const Result<DirectedCurve> curve = read_curve(file, instance, basis, units, trail);
    if (!curve) return curve.error();
    const Result<double> from =
        parameter_of(file, instance, *first, basis, *curve, prefer_parameter, units);
    if (!from) return from.error();
    Result<double> to =
        parameter_of(file, instance, *second, basis, *curve, prefer_parameter, units);
    if (!to) return to.error();
    const bool rises = curve->same_sense == agrees;
    if (const double turn = period(curve->curve); turn > 0) {
        // Ends closer than this share of a turn are one point: once around.
        constexpr double rounding = 1e-9;
        const double turns = (rises ? *to - *from : *from - *to) / turn;
        const double share = turns - std::floor(turns);
        const double length = (share > rounding ? share : 1.0) * turn;
        *to = rises ? *from + length : *from - length;
    }
    if (*from == *to || rises != (*from < *to)) {
        return file.error(instance,
                          named(file, instance) + ": its ends contradict its sense_agreement");
    }
    return BoundedCurve{curve->curve, *from, *to};
}

BSplineCurve as_spline(const BoundedCurve& piece) {
    if (piece.from < piece.to) return rational(piece.curve, piece.from, piece.to);
    return reversed(rational(piece.curve, piece.to, piece.from));
}

}  // namespace

Result<std::optional<double>> parameter_scale(const File& file, InstanceIndex curve,
                                              const DirectedCurve& read, const Units& units) {
    const std::string_view type = keyword(file, curve);
    const bool is_own = read.same_sense && type != "TRIMMED_CURVE" && !is_composite(type) &&
                        !file.is(curve, "PCURVE") && type != "BOUNDED_PCURVE" &&
                        type != "OFFSET_CURVE_3D" && type != "OFFSET_CURVE_2D";
    if (!is_own) return std::optional<double>();
    if (std::holds_alternative<Circle>(read.curve) || std::holds_alternative<Ellipse>(read.curve))
        return std::optional(units.angle_rad);
    if (!std::holds_alternative<Line>(read.curve)) return std::optional(1.0);
    Fields fields(file, curve, 3);
    const InstanceIndex vector = fields.reference(2);
    if (!fields.ok()) return fields.error();
    Fields vector_fields(file, vector, 3);
    const double magnitude = vector_fields.real(2);
    if (!vector_fields.ok()) return vector_fields.error();
    return std::optional(std::abs(magnitude) * units.length_mm);
}

Result<BoundedCurve> read_bounded_curve(const File& file, InstanceIndex user, InstanceIndex curve,
                                        const Units& units, part21::Trail& trail) {
    if (keyword(file, curve) == "TRIMMED_CURVE") {
        const auto step = trail.enter(curve);
        if (!step) return step.error();
        return read_trimmed(file, curve, units, trail);
    }
    const Result<DirectedCurve> whole = read_curve(file, user, curve, units, trail);
    if (!whole) return whole.error();
    BoundedCurve result{whole->curve, 0, period(whole->curve)};
    if (const auto* spline = std::get_if<BSplineCurve>(&whole->curve)) {
        result.from = spline->domain_start();
        result.to = spline->domain_end();
    } else if (!(result.to > 0)) {
        return file.error(user, named(file, user) + ": a curve with two ends expected, found " +
                                    named(file, curve));
    }
    if (!whole->same_sense) std::swap(result.from, result.to);
    return result;
}

bool is_composite(std::string_view type) {
    return type == "COMPOSITE_CURVE" || type == "COMPOSITE_CURVE_ON_SURFACE" ||
           type == "BOUNDARY_CURVE" || type == "OUTER_BOUNDARY_CURVE";
}

Result<BSplineCurve> read_composite(const File& file, InstanceIndex instance, const Units& units,
                                    part21::Trail& trail) {
    Fields fields(file, instance, 3);
    const std::vector<InstanceIndex> segments = fields.references(1);
    if (!fields.ok()) return fields.error();
    if (segments.empty()) return file.error(instance, named(file, instance) + " has no segments");
    std::vector<BSplineCurve> pieces;
    int degree = 1;
    for (const InstanceIndex segment : segments) {
        // transition, same_sense, parent_curve
        Fields segment_fields(file, segment, 3);
        const bool same_sense = segment_fields.boolean(1);
        const InstanceIndex parent = segment_fields.reference(2);
        if (!segment_fields.ok()) return segment_fields.error();
        Result<BoundedCurve> piece = read_bounded_curve(file, segment, parent, units, trail);
        if (!piece) return piece.error();
        if (!same_sense) std::swap(piece->from, piece->to);
        pieces.push_back(as_spline(*piece));
        degree = std::max(degree, pieces.back().degree);
    }
    const double closeness_mm = std::max(resolution_mm, units.uncertainty_mm);
    BSplineCurve whole = elevated(pieces.front(), degree);
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        const Point3 end = evaluate(whole, whole.domain_end());
        const Point3 start = evaluate(pieces[i], pieces[i].domain_start());
        if ((end - start).norm() > closeness_mm) {
            return file.error(segments[i], named(file, segments[i]) +
                                               " does not begin where the segment before it ends");
        }
        whole = joined(std::move(whole), elevated(pieces[i], degree));
    }
    const Point3 start = evaluate(whole, whole.domain_start());
    whole.closed = (start - evaluate(whole, whole.domain_end())).norm() <= resolution_mm;
    return whole;
}

}  // namespace lyr::importer
