// Lines that a user puts before and after a print, with {placeholders}.
//
// Contract
//  1. `{name}` becomes the value of that name; `{{` and `}}` are braces. Anything else stays as it is.
//  2. A name that is not known is an error (status usage) with the line and the nearest that is.

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "format/reader.h"

namespace lyr::format {

using Placeholders = std::vector<std::pair<std::string, std::string>>;

// Of a print and its first layer.
Placeholders placeholders_of(const FileHeader& header, const Layer& first,
                             double nozzle_diameter_mm);

// `name` is the macro's, for messages. Each line ends with a line feed.
Result<std::string> expanded(std::span<const std::string> lines, const Placeholders& placeholders,
                             const std::string& name);

// Whether one of the words stands in the lines, comments apart. So a macro shows that it heats by itself: by its commands
// or by the temperatures that it hands on.
bool mentions(std::span<const std::string> lines, std::span<const std::string_view> words);

// The target that a layer states; 0: none.
double stated_target_c(const LayerState& state, HeaterKind kind, std::uint32_t tool);

}  // namespace lyr::format
