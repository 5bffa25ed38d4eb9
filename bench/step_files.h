// Which STEP files to measure with.

#pragma once

#include <string>
#include <vector>

namespace lyr::bench {

// The STEP files in a folder (not below it), sorted; a path to a file gives that file.
std::vector<std::string> step_files(const std::string& path);

}  // namespace lyr::bench
