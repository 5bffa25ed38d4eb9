// Where an export goes, piece by piece: a file, a pipe, a test's string.

#pragma once

#include <functional>
#include <string_view>

namespace lyr::format {

using Sink = std::function<void(std::string_view)>;

}  // namespace lyr::format
