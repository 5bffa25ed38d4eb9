// Knot vectors spelt out.

#include "parser/import/knots.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lyr::importer {

namespace {

Result<std::vector<double>> stated_knots(const File& file, InstanceIndex instance,
                                         const KnotRequest& request) {
    const auto wrong = [&](const std::string& what) {
        return file.error(instance, named(file, instance) + ": " + what);
    };
    if (request.multiplicities.size() != request.values.size())
        return wrong("as many multiplicities as knots expected");
    const std::size_t expected = request.points + static_cast<std::size_t>(request.degree) + 1;
    std::vector<double> knots;
    for (std::size_t i = 0; i < request.values.size(); ++i) {
        const std::int64_t multiplicity = request.multiplicities[i];
        if (multiplicity < 1 || multiplicity > request.degree + 1) {
            return wrong("knot multiplicities from 1 to degree + 1 expected");
        }
        const double value = request.values[i];
        if (!std::isfinite(value) || (i > 0 && value < request.values[i - 1])) {
            return wrong("ascending knots expected");
        }
        knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), value);
        if (knots.size() > expected) break;
    }
    if (knots.size() != expected) {
        return wrong("the multiplicities must add up to points + degree + 1 = " +
                     std::to_string(expected));
    }
    return knots;
}

Result<std::vector<double>> knots_of_form(const File& file, InstanceIndex instance,
                                          const KnotRequest& request) {
    const auto degree = static_cast<std::size_t>(request.degree);
    const std::size_t count = request.points + degree + 1;
    switch (request.form) {
        case KnotForm::stated:
            return stated_knots(file, instance, request);
        case KnotForm::uniform:
            return integer_knots(count, 1, 1);
        case KnotForm::quasi_uniform:
            return integer_knots(count, degree + 1, 1);
        case KnotForm::bezier:
            break;
    }
    if ((request.points - 1) % degree != 0) {
        return file.error(
            instance, named(file, instance) + ": a multiple of degree, plus 1, points expected");
    }
    return integer_knots(count, degree + 1, degree);
}

}  // namespace

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

Result<std::vector<double>> read_knots(const File& file, InstanceIndex instance,
                                       const KnotRequest& request) {
    Result<std::vector<double>> knots = knots_of_form(file, instance, request);
    if (!knots) return knots.error();
    if (!((*knots)[static_cast<std::size_t>(request.degree)] < (*knots)[request.points])) {
        return file.error(instance, named(file, instance) + ": the knots leave no domain");
    }
    return knots;
}

Result<int> checked_degree(const File& file, InstanceIndex instance, std::int64_t stated,
                           std::size_t points, int highest) {
    if (stated < 1 || stated >= static_cast<std::int64_t>(points)) {
        return file.error(instance, named(file, instance) +
                                        ": a degree from 1 to the number of points - 1 (" +
                                        std::to_string(points) + " points) expected, found " +
                                        std::to_string(stated));
    }
    if (stated > highest)
        return unsupported(file, instance, "a spline of degree " + std::to_string(stated));
    return static_cast<int>(stated);
}

Result<std::vector<double>> checked_weights(const File& file, InstanceIndex instance,
                                            std::vector<double> weights, std::size_t points) {
    const bool positive = std::all_of(weights.begin(), weights.end(),
                                      [](double w) { return w > 0 && std::isfinite(w); });
    if (!positive || weights.size() != points) {
        return file.error(instance,
                          named(file, instance) + ": one positive weight for each point expected");
    }
    const bool equal =
        std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights.front(); });
    if (equal) weights.clear();
    return weights;
}

}  // namespace lyr::importer
