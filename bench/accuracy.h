// How far the contours of a print lie from the model's surfaces, by OCCT's projection, which the slicer does not use.

#pragma once

#include <cstddef>
#include <string>

#include "base/diagnostic.h"
#include "bench/table.h"

namespace lyr::bench {

// Prints the part, reads the walls back from the .lyr file and measures points spread evenly along them.
Status measure_accuracy(const std::string& step_path, double layer_height_mm, std::size_t points,
                        Requirements& requirements);

}  // namespace lyr::bench
