// Degrees, knots and weights of the B-spline forms of ISO 10303-42, which curves and surfaces state alike.

#pragma once

#include <string_view>
#include <vector>

#include "parser/import/entity.h"

namespace lyr::importer {

// How the knots are given: one by one, or by a rule that the entity's name stands for.
enum class KnotForm { stated, uniform, quasi_uniform, bezier };

// One direction of a spline: `points` control points.
struct KnotRequest {
    KnotForm form;
    int degree;
    std::size_t points;
    // For KnotForm::stated, as in the file.
    std::vector<std::int64_t> multiplicities = {};
    std::vector<double> values = {};
};

// With multiplicity: points + degree + 1 of them, ascending, with a domain that is not empty. Anything else is an
// error.
Result<std::vector<double>> read_knots(const File& file, InstanceIndex instance,
                                       const KnotRequest& request);

// Knots 0, 1, 2... of which the first and last have the multiplicity `ends`, the others `inner`.
std::vector<double> integer_knots(std::size_t count, std::size_t ends, std::size_t inner);

// From 1 to the number of points - 1, and no more than `highest`.
Result<int> checked_degree(const File& file, InstanceIndex instance, std::int64_t stated,
                           std::size_t points, int highest);

// One positive weight for each point, or an error; none if all are equal.
Result<std::vector<double>> checked_weights(const File& file, InstanceIndex instance,
                                            std::vector<double> weights, std::size_t points);

}  // namespace lyr::importer
