// How far the contours of a print lie from the model's surfaces, by OCCT's projection, which the slicer does not use.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "bench/occt.h"
#include "bench/table.h"
#include "kernel/geometry/vector.h"

namespace lyr::bench {

// Prints the part, reads the walls back from the .lyr file and measures points spread evenly along them.
Status measure_accuracy(const std::string& step_path, double layer_height_mm, std::size_t points,
                        Requirements& requirements);

// Prints the part with walls all along its outline, however narrow it is: points spread evenly along its outermost
// walls, on their outer flanks, in the model's own coordinates.
Result<std::vector<Point3>> printed_points(const std::string& step_path, double layer_height_mm,
                                           std::size_t count);

// From the nearest surface, sorted.
std::vector<double> distances_mm(const occt::Surfaces& surfaces, const std::vector<Point3>& points);

// The distance that this share of the points, 0 to 1, does not exceed.
double quantile(const std::vector<double>& sorted, double share);

}  // namespace lyr::bench
