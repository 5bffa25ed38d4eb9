// What stands before and after the motions of a print as G-code: comments for people, viewers and print servers, heating
// up, the user's lines. Private to this room; gcode.h has the contract.

#pragma once

#include <cstdint>
#include <string>

#include "base/diagnostic.h"
#include "format/export/gcode.h"
#include "format/reader.h"

namespace lyr::format {

// Up to the first layer, which the reader has begun.
Result<std::string> gcode_head(const Reader& reader, const GcodeOptions& options);

struct GcodeEnd {
    double z_mm = 0;  // of the nozzle
    std::uint32_t tool = 0;
    bool chamber = false;  // was heated
};

// Behind the last layer. `first` and `height_mm` are the first layer and the thickness of those that follow.
Result<std::string> gcode_foot(const FileHeader& header, const Layer& first, double height_mm,
                               const GcodeEnd& end, const GcodeOptions& options);

// A temperature as a command; one for each kind of heater.
std::string temperature_command(const Heater& heater, double target_c, bool wait);

// "object_3", or the object's name as the firmware may have it.
std::string object_label(const Metadata& metadata, std::uint32_t object);

}  // namespace lyr::format
