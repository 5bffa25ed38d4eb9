// A small text file, or standard input, as a whole.

#pragma once

#include <cstddef>
#include <string>

#include "base/diagnostic.h"

namespace lyr {

// What messages call the input that is named "-".
inline constexpr const char* standard_input_name = "standard input";

// "-" is standard input, from where it stands. Errors (status input): unreadable, a folder, more than `most_bytes`.
Result<std::string> read_text(const std::string& path, std::size_t most_bytes);

}  // namespace lyr
