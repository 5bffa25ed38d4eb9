// The metadata block's text: one `key=value` a line, with \\ for a backslash and \n for a line's
// end within a value.
//
// Contract
//  1. parse(print(metadata, summary)) = (metadata, summary), configuration and thumbnails apart;
//     numbers are printed so that they read back as the same double.
//  2. parse refuses lines without '=' and values that are no measure, naming the line.

#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "format/metadata.h"

namespace lyr::format {

// A number that metadata may have: nothing that it measures is larger than this.
inline constexpr double largest_measure = 1e12;
inline bool is_measure(double value) {
    return std::abs(value) <= largest_measure;
}

// In the library lyr_format_writer.
std::string print_metadata(const Metadata& metadata, const Summary& summary);

// May Metadata::extra have this key: is it a word, and none of the format's own keys?
bool is_extra_key(std::string_view key);

struct ParsedMetadata {
    Metadata metadata;
    Summary summary;
    std::optional<std::string> error;
};

ParsedMetadata parse_metadata(std::string_view text);

}  // namespace lyr::format
