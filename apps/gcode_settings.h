// How a print is to be written as G-code: what its own configuration says, and over that the command line.

#pragma once

#include "apps/export_format.h"
#include "format/export/gcode.h"

namespace lyr::command_line {

// `configuration` is the file's, as stepc wrote it; another's says nothing. Errors: files of lines that cannot be read
// (input), values that are none (usage).
Result<format::GcodeOptions> gcode_settings(const std::string& configuration,
                                            const GcodeRequest& request);

}  // namespace lyr::command_line
