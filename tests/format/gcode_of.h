// A print as the text of its G-code.

#pragma once

#include <doctest/doctest.h>

#include <string>
#include <string_view>

#include "format/export/gcode.h"
#include "format/reader.h"

namespace lyr::format::test {

inline std::string gcode_of(const std::string& path, const GcodeOptions& options,
                            Diagnostics& diagnostics) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::string text;
    const Status done = write_gcode(
        *reader, options, [&](std::string_view piece) { text += piece; }, diagnostics);
    REQUIRE_MESSAGE(done.ok(), to_string(done.error()));
    return text;
}

inline std::string gcode_of(const std::string& path, const GcodeOptions& options) {
    Diagnostics diagnostics;
    return gcode_of(path, options, diagnostics);
}

}  // namespace lyr::format::test
