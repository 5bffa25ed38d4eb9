// Time a section: all planes of a print by us, a sample of them by OCCT.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/table.h"

namespace lyr::bench {

struct PartToCut {
    std::string path;
    double layer_height_mm;
    std::optional<double> required_ratio{};  // OCCT's time a plane to ours
};

// Prints the tables. A part that one side cannot read or cut has a line that says so; where it is ours, its requirement
// is missed.
void compare_sections(const std::vector<PartToCut>& parts, Requirements& requirements);

}  // namespace lyr::bench
