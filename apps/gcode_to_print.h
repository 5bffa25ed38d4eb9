// G-code of whatever slicer as a print.

#pragma once

#include <string>

#include "base/diagnostic.h"

namespace lyr::command_line {

// What came of it, for people. Errors: those of reading (input) and writing (output), and text that is no G-code (input).
Result<std::string> gcode_to_print(const std::string& gcode_path, const std::string& lyr_path,
                                   Diagnostics& diagnostics);

}  // namespace lyr::command_line
