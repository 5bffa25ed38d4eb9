// A file, or standard input, as a whole.

#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostic.h"

namespace lyr {

// What messages call the input that is named "-".
inline constexpr const char* standard_input_name = "standard input";

// What is asked of a file's first bytes before the rest is read: what is wrong with them, or nothing.
struct HeadCheck {
    std::size_t bytes = 0;  // that it looks at; fewer if the file is shorter
    std::function<std::optional<std::string>(std::string_view)> wrong{};
};

// "-" is standard input, from where it stands. Errors (status input): unreadable, a folder, more than `most_bytes`, or what
// the check says.
Result<std::string> read_text(const std::string& path, std::size_t most_bytes,
                              const HeadCheck& check = {});

// What is read of a pipe or a device, which may have no end, where a file is read whatever its size.
inline constexpr std::size_t most_streamed_bytes = std::size_t{1} << 28;
// The bound for this path: a file's is that of memory.
std::size_t most_readable_bytes(const std::string& path);

}  // namespace lyr
