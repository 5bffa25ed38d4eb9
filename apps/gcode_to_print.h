// G-code of whatever slicer as a print.

#pragma once

#include <string>

#include "base/diagnostic.h"

namespace lyr::command_line {

// What came of it, for people. A filament's diameter of 0 is as the comments say. Errors: those of reading (input)
// and writing (output), and text that is no G-code (input).
Result<std::string> gcode_to_print(const std::string& gcode_path, const std::string& lyr_path,
                                   double filament_diameter_mm, Diagnostics& diagnostics);

}  // namespace lyr::command_line
