// The profiles that every stepc has within it: the files of profile/built_in/, as they are.

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lyr::profile {

struct BuiltIn {
    std::string_view name;  // "abs"
    std::string_view text;  // of abs.toml
};

// By name.
std::span<const BuiltIn> built_ins();

std::vector<std::string> built_in_names();

}  // namespace lyr::profile
