// B-splines: the supertype's attributes (degrees, points), then the knots of the form, then weights.

#include "parser/import/bspline.h"

#include <algorithm>
#include <array>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/knots.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

struct FormNames {
    std::string_view stated, uniform, quasi_uniform, bezier;
};
constexpr FormNames curve_forms{"B_SPLINE_CURVE_WITH_KNOTS", "UNIFORM_CURVE", "QUASI_UNIFORM_CURVE",
                                "BEZIER_CURVE"};
constexpr FormNames surface_forms{"B_SPLINE_SURFACE_WITH_KNOTS", "UNIFORM_SURFACE",
                                  "QUASI_UNIFORM_SURFACE", "BEZIER_SURFACE"};

bool is_form(std::string_view type, const FormNames& names) {
    return type == names.stated || type == names.uniform || type == names.quasi_uniform ||
           type == names.bezier;
}

Result<KnotForm> form_of(const File& file, InstanceIndex instance, const FormNames& names) {
    if (file.is(instance, names.stated)) return KnotForm::stated;
    if (file.is(instance, names.uniform)) return KnotForm::uniform;
    if (file.is(instance, names.quasi_uniform)) return KnotForm::quasi_uniform;
    if (file.is(instance, names.bezier)) return KnotForm::bezier;
    return file.error(instance,
                      named(file, instance) + ": a B-spline without a form that gives its knots");
}

Status read_points(const File& file, InstanceIndex user,
                   const std::vector<InstanceIndex>& instances, const Units& units,
                   std::vector<Point3>& points) {
    points.reserve(points.size() + instances.size());
    for (const InstanceIndex instance : instances) {
        const Result<Point3> point = read_point(file, user, instance, units);
        if (!point) return point.error();
        points.push_back(*point);
    }
    return Done{};
}

Status read_curve_knots(const File& file, InstanceIndex instance, BSplineCurve& curve) {
    const Result<KnotForm> form = form_of(file, instance, curve_forms);
    if (!form) return form.error();
    KnotRequest request{*form, curve.degree, curve.control_points.size()};
    if (*form == KnotForm::stated) {
        Attributes a(file, instance, curve_forms.stated, 6, 3);
        request.multiplicities = a.fields.integers(a.first);
        request.values = a.fields.reals(a.first + 1);
        if (!a.fields.ok()) return a.fields.error();
    }
    Result<std::vector<double>> knots = read_knots(file, instance, request);
    if (!knots) return knots.error();
    curve.knots = std::move(*knots);
    return Done{};
}

Status read_curve_weights(const File& file, InstanceIndex instance, BSplineCurve& curve) {
    if (!file.is(instance, "RATIONAL_B_SPLINE_CURVE")) return Done{};
    Attributes a(file, instance, "RATIONAL_B_SPLINE_CURVE", 6, 1);
    std::vector<double> stated = a.fields.reals(a.first);
    if (!a.fields.ok()) return a.fields.error();
    Result<std::vector<double>> weights =
        checked_weights(file, instance, std::move(stated), curve.control_points.size());
    if (!weights) return weights.error();
    curve.weights = std::move(*weights);
    return Done{};
}

void find_closure(BSplineCurve& curve) {
    // The flag of the file is often wrong and may be unknown; what counts is where the ends are.
    const Point3 start = evaluate(curve, curve.domain_start());
    curve.closed = (start - evaluate(curve, curve.domain_end())).norm() <= resolution_mm;
}

// The members of a list of lists in one row; all inner lists must be `row` long (0: as long as the first, which sets
// it).
template <class T>
Result<std::vector<T>> read_grid(const part21::List& list, std::size_t& row,
                                 Status (part21::Value::*append)(std::vector<T>&) const) {
    std::vector<T> all;
    for (const part21::Value& line : list) {
        const std::size_t before = all.size();
        if (const Status status = (line.*append)(all); !status) return status.error();
        if (row == 0) row = all.size();
        if (row == 0 || all.size() - before != row) {
            return line.expected("a list of " + std::to_string(row));
        }
    }
    return all;
}

Status read_net(const File& file, InstanceIndex instance, const Units& units, BSplineSurface& s) {
    // Simple instances carry all attributes, those of the form last.
    const bool with_knots = file.is(instance, surface_forms.stated);
    const std::size_t own = file.is_complex(instance) || !with_knots ? 7 : 12;
    Attributes a(file, instance, "B_SPLINE_SURFACE", 1, own);
    const std::int64_t degree_u = a.fields.integer(a.first);
    const std::int64_t degree_v = a.fields.integer(a.first + 1);
    const part21::List net = a.fields.list(a.first + 2);
    if (!a.fields.ok()) return a.fields.error();
    s.count_v = 0;
    const auto instances = read_grid(net, s.count_v, &part21::Value::append_references);
    if (!instances) return instances.error();
    if (instances->empty())
        return file.error(instance, named(file, instance) + " has no control points");
    s.count_u = instances->size() / s.count_v;
    const Result<int> u =
        checked_degree(file, instance, degree_u, s.count_u, highest_surface_degree);
    if (!u) return u.error();
    const Result<int> v =
        checked_degree(file, instance, degree_v, s.count_v, highest_surface_degree);
    if (!v) return v.error();
    s.degree_u = *u;
    s.degree_v = *v;
    return read_points(file, instance, *instances, units, s.control_points);
}

Status read_surface_knots(const File& file, InstanceIndex instance, BSplineSurface& s) {
    const Result<KnotForm> form = form_of(file, instance, surface_forms);
    if (!form) return form.error();
    KnotRequest u{*form, s.degree_u, s.count_u}, v{*form, s.degree_v, s.count_v};
    if (*form == KnotForm::stated) {
        Attributes a(file, instance, surface_forms.stated, 8, 5);
        u.multiplicities = a.fields.integers(a.first);
        v.multiplicities = a.fields.integers(a.first + 1);
        u.values = a.fields.reals(a.first + 2);
        v.values = a.fields.reals(a.first + 3);
        if (!a.fields.ok()) return a.fields.error();
    }
    Result<std::vector<double>> knots_u = read_knots(file, instance, u);
    if (!knots_u) return knots_u.error();
    Result<std::vector<double>> knots_v = read_knots(file, instance, v);
    if (!knots_v) return knots_v.error();
    s.knots_u = std::move(*knots_u);
    s.knots_v = std::move(*knots_v);
    return Done{};
}

Status read_surface_weights(const File& file, InstanceIndex instance, BSplineSurface& s) {
    if (!file.is(instance, "RATIONAL_B_SPLINE_SURFACE")) return Done{};
    Attributes a(file, instance, "RATIONAL_B_SPLINE_SURFACE", 8, 1);
    const part21::List net = a.fields.list(a.first);
    if (!a.fields.ok()) return a.fields.error();
    std::size_t row = s.count_v;
    Result<std::vector<double>> stated = read_grid(net, row, &part21::Value::append_reals);
    if (!stated) return stated.error();
    Result<std::vector<double>> weights =
        checked_weights(file, instance, std::move(*stated), s.control_points.size());
    if (!weights) return weights.error();
    s.weights = std::move(*weights);
    return Done{};
}

// Whether the border lines at both ends of one parameter are the same curve, to within `closeness_mm`, and the surface
// between them goes farther than that. Two rational curves of degree n are one if they meet in 2 n + 1 points of each
// span.
bool borders_meet(const BSplineSurface& s, bool along_u, double closeness_mm) {
    const double first = along_u ? s.start_u() : s.start_v(),
                 last = along_u ? s.end_u() : s.end_v();
    const std::vector<double>& knots = along_u ? s.knots_v : s.knots_u;
    const auto degree = static_cast<std::size_t>(along_u ? s.degree_v : s.degree_u);
    const std::size_t count = along_u ? s.count_v : s.count_u, steps = 2 * degree;
    const auto at = [&](double across, double along) {
        return evaluate(s, along_u ? Point2(across, along) : Point2(along, across));
    };
    constexpr double clearly_farther = 10;
    double reach_mm = 0;
    for (std::size_t span = degree; span < count; ++span) {
        if (!(knots[span] < knots[span + 1])) continue;
        for (std::size_t i = 0; i <= steps; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(steps);
            const double t = knots[span] + share * (knots[span + 1] - knots[span]);
            const Point3 border = at(first, t);
            if ((border - at(last, t)).norm() > closeness_mm) return false;
            reach_mm = std::max(reach_mm, (border - at((first + last) / 2, t)).norm());
        }
    }
    return reach_mm > clearly_farther * closeness_mm;
}

}  // namespace

bool is_bspline_curve(const File& file, InstanceIndex instance) {
    if (file.is_complex(instance)) return file.is(instance, "B_SPLINE_CURVE");
    return is_form(keyword(file, instance), curve_forms);
}

bool is_bspline_surface(const File& file, InstanceIndex instance) {
    if (file.is_complex(instance)) return file.is(instance, "B_SPLINE_SURFACE");
    return is_form(keyword(file, instance), surface_forms);
}

Result<BSplineCurve> read_bspline_curve(const File& file, InstanceIndex instance,
                                        const Units& units) {
    BSplineCurve curve{};
    const bool with_knots = file.is(instance, curve_forms.stated);
    const std::size_t own = file.is_complex(instance) || !with_knots ? 5 : 8;
    Attributes a(file, instance, "B_SPLINE_CURVE", 1, own);
    const std::int64_t stated_degree = a.fields.integer(a.first);
    const std::vector<InstanceIndex> instances = a.fields.references(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    // Modellers stop below 30. A higher degree is a damaged number, and the work grows with its cube.
    constexpr int highest_degree = 100;
    const Result<int> degree =
        checked_degree(file, instance, stated_degree, instances.size(), highest_degree);
    if (!degree) return degree.error();
    curve.degree = *degree;
    Status status = read_points(file, instance, instances, units, curve.control_points);
    if (status) status = read_curve_knots(file, instance, curve);
    if (status) status = read_curve_weights(file, instance, curve);
    if (!status) return status.error();
    find_closure(curve);
    return curve;
}

Result<BSplineCurve> read_polyline(const File& file, InstanceIndex instance, const Units& units) {
    Fields fields(file, instance, 2);
    const std::vector<InstanceIndex> instances = fields.references(1);
    if (!fields.ok()) return fields.error();
    if (instances.size() < 2)
        return file.error(instance, named(file, instance) + ": two points or more expected");
    BSplineCurve curve{1, integer_knots(instances.size() + 2, 2, 1), {}, {}, false};
    const Status status = read_points(file, instance, instances, units, curve.control_points);
    if (!status) return status.error();
    find_closure(curve);
    return curve;
}

Result<BSplineSurface> read_bspline_surface(const File& file, InstanceIndex instance,
                                            const Units& units) {
    BSplineSurface s{};
    Status status = read_net(file, instance, units, s);
    if (status) status = read_surface_knots(file, instance, s);
    if (status) status = read_surface_weights(file, instance, s);
    if (!status) return status.error();
    const double closeness_mm = std::max(resolution_mm, units.uncertainty_mm);
    s.closed_u = borders_meet(s, true, closeness_mm);
    s.closed_v = borders_meet(s, false, closeness_mm);
    return s;
}

}  // namespace lyr::importer
