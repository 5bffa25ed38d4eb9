// A print as long as one likes: the layers of a .lyr file over and over, as parts printed one after the other are.

#pragma once

#include <cstdint>
#include <string>

#include "base/diagnostic.h"

namespace lyr::bench {

// Writes whole rounds of the layers of the file at `path` to `long_path` until it has at least `bytes`. Errors: input,
// output.
Status write_long_print(const std::string& path, const std::string& long_path, std::uint64_t bytes);

}  // namespace lyr::bench
