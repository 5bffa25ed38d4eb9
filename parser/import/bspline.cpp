// B-spline curves: the supertype's attributes (degree, points), then the knots of the form, then weights.

#include "parser/import/bspline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/geometry/bspline_curve.h"
#include "kernel/geometry/tolerance.h"
#include "parser/import/placement.h"

namespace lyr::importer {

namespace {

constexpr std::array forms{
    std::string_view("B_SPLINE_CURVE_WITH_KNOTS"), std::string_view("UNIFORM_CURVE"),
    std::string_view("QUASI_UNIFORM_CURVE"), std::string_view("BEZIER_CURVE")};

Result<std::vector<Point3>> read_points(const File& file, InstanceIndex user,
                                        const std::vector<InstanceIndex>& instances,
                                        const Units& units) {
    std::vector<Point3> points;
    points.reserve(instances.size());
    for (const InstanceIndex instance : instances) {
        const Result<Point3> point = read_point(file, user, instance, units);
        if (!point) return point.error();
        points.push_back(*point);
    }
    return points;
}

Result<std::vector<double>> stated_knots(const File& file, InstanceIndex instance,
                                         const BSplineCurve& curve) {
    Attributes a(file, instance, "B_SPLINE_CURVE_WITH_KNOTS", 6, 3);
    const std::vector<std::int64_t> multiplicities = a.fields.integers(a.first);
    const std::vector<double> values = a.fields.reals(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    const auto wrong = [&](const std::string& what) {
        return file.error(instance, named(file, instance) + ": " + what);
    };
    if (multiplicities.size() != values.size())
        return wrong("as many multiplicities as knots expected");
    const std::size_t expected =
        curve.control_points.size() + static_cast<std::size_t>(curve.degree) + 1;
    std::vector<double> knots;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (multiplicities[i] < 1 || multiplicities[i] > curve.degree + 1) {
            return wrong("knot multiplicities from 1 to degree + 1 expected");
        }
        if (!std::isfinite(values[i]) || (i > 0 && values[i] < values[i - 1])) {
            return wrong("ascending knots expected");
        }
        knots.insert(knots.end(), static_cast<std::size_t>(multiplicities[i]), values[i]);
        if (knots.size() > expected) break;
    }
    if (knots.size() != expected) {
        return wrong("the multiplicities must add up to points + degree + 1 = " +
                     std::to_string(expected));
    }
    return knots;
}

// Knots 0, 1, 2... of which the first and last have the multiplicity `ends`, the others `inner`.
std::vector<double> integer_knots(std::size_t count, std::size_t ends, std::size_t inner) {
    std::vector<double> knots;
    double value = 0;
    while (knots.size() < count) {
        const bool is_end = knots.empty() || knots.size() + ends >= count;
        knots.insert(knots.end(), is_end ? ends : inner, value);
        ++value;
    }
    return knots;
}

Result<std::vector<double>> knots_of_form(const File& file, InstanceIndex instance,
                                          const BSplineCurve& curve) {
    const auto degree = static_cast<std::size_t>(curve.degree);
    const std::size_t count = curve.control_points.size() + degree + 1;
    if (file.is(instance, "B_SPLINE_CURVE_WITH_KNOTS")) return stated_knots(file, instance, curve);
    if (file.is(instance, "QUASI_UNIFORM_CURVE")) return integer_knots(count, degree + 1, 1);
    if (file.is(instance, "UNIFORM_CURVE")) return integer_knots(count, 1, 1);
    if (file.is(instance, "BEZIER_CURVE")) {
        if ((curve.control_points.size() - 1) % degree != 0) {
            return file.error(instance, named(file, instance) +
                                            ": a multiple of degree, plus 1, points expected");
        }
        return integer_knots(count, degree + 1, degree);
    }
    return file.error(
        instance, named(file, instance) + ": a B-spline curve without a form that gives its knots");
}

Status read_weights(const File& file, InstanceIndex instance, BSplineCurve& curve) {
    if (!file.is(instance, "RATIONAL_B_SPLINE_CURVE")) return Done{};
    Attributes a(file, instance, "RATIONAL_B_SPLINE_CURVE", 6, 1);
    curve.weights = a.fields.reals(a.first);
    if (!a.fields.ok()) return a.fields.error();
    const bool positive = std::all_of(curve.weights.begin(), curve.weights.end(),
                                      [](double w) { return w > 0 && std::isfinite(w); });
    if (!positive || curve.weights.size() != curve.control_points.size()) {
        return file.error(instance,
                          named(file, instance) + ": one positive weight for each point expected");
    }
    const bool equal = std::all_of(curve.weights.begin(), curve.weights.end(),
                                   [&](double w) { return w == curve.weights.front(); });
    if (equal) curve.weights.clear();
    return Done{};
}

void find_closure(BSplineCurve& curve) {
    // The flag of the file is often wrong and may be unknown; what counts is where the ends are.
    const Point3 start = evaluate(curve, curve.domain_start());
    curve.closed = (start - evaluate(curve, curve.domain_end())).norm() <= resolution_mm;
}

}  // namespace

bool is_bspline_curve(const File& file, InstanceIndex instance) {
    if (file.is_complex(instance)) return file.is(instance, "B_SPLINE_CURVE");
    return std::find(forms.begin(), forms.end(), keyword(file, instance)) != forms.end();
}

Result<BSplineCurve> read_bspline_curve(const File& file, InstanceIndex instance,
                                        const Units& units) {
    BSplineCurve curve{};
    // Simple instances carry all attributes, those of the form last.
    const bool with_knots = file.is(instance, "B_SPLINE_CURVE_WITH_KNOTS");
    const std::size_t own = file.is_complex(instance) || !with_knots ? 5 : 8;
    Attributes a(file, instance, "B_SPLINE_CURVE", 1, own);
    const std::int64_t degree = a.fields.integer(a.first);
    const std::vector<InstanceIndex> instances = a.fields.references(a.first + 1);
    if (!a.fields.ok()) return a.fields.error();
    if (degree < 1 || degree >= static_cast<std::int64_t>(instances.size())) {
        return file.error(instance, named(file, instance) +
                                        ": a degree from 1 to the number of points - 1 (" +
                                        std::to_string(instances.size()) +
                                        " points) expected, found " + std::to_string(degree));
    }
    // Modellers stop below 30. A higher degree is a damaged number, and the work grows with its cube.
    constexpr std::int64_t highest_degree = 100;
    if (degree > highest_degree)
        return unsupported(file, instance, "a curve of degree " + std::to_string(degree));
    curve.degree = static_cast<int>(degree);
    Result<std::vector<Point3>> points = read_points(file, instance, instances, units);
    if (!points) return points.error();
    curve.control_points = std::move(*points);
    Result<std::vector<double>> knots = knots_of_form(file, instance, curve);
    if (!knots) return knots.error();
    curve.knots = std::move(*knots);
    if (const Status status = read_weights(file, instance, curve); !status) return status.error();
    if (!(curve.domain_start() < curve.domain_end())) {
        return file.error(instance, named(file, instance) + ": the knots leave no domain");
    }
    find_closure(curve);
    return curve;
}

Result<BSplineCurve> read_polyline(const File& file, InstanceIndex instance, const Units& units) {
    Fields fields(file, instance, 2);
    const std::vector<InstanceIndex> instances = fields.references(1);
    if (!fields.ok()) return fields.error();
    if (instances.size() < 2)
        return file.error(instance, named(file, instance) + ": two points or more expected");
    Result<std::vector<Point3>> points = read_points(file, instance, instances, units);
    if (!points) return points.error();
    BSplineCurve curve{1, integer_knots(points->size() + 2, 2, 1), std::move(*points), {}, false};
    find_closure(curve);
    return curve;
}

}  // namespace lyr::importer
