// Reading and importing STEP files: MB/s of ours and of OCCT, file by file.

#pragma once

#include <string>
#include <vector>

#include "bench/table.h"

namespace lyr::bench {

// Prints the table, file by file if they are few. MB are 10^6 bytes.
void compare_reading(const std::vector<std::string>& paths, Requirements& requirements);

}  // namespace lyr::bench
