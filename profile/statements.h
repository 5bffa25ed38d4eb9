// The text of a profile as a list of what it says. Private to this room.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "profile/values.h"

namespace lyr::profile {

struct Statement {
    std::string path;  // "layer.height"; parts that hold a dot themselves are in quotes
    Given value;
    std::uint32_t line = 0, column = 0;
    bool empty_section = false;  // [layer] with nothing below it; no value
};

// In the order of the text. `file` names it in messages. Errors (input, with line and column): not TOML; a key that
// stands twice.
Result<std::vector<Statement>> statements_of(std::string_view text, const std::string& file);

}  // namespace lyr::profile
