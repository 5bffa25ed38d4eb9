// The field's names of roles, as people read them.

#include "format/operation.h"

namespace lyr::format {

std::string_view name_of(Role role) {
    constexpr std::array<std::string_view, role_count> names{
        "other",         "outer wall",    "inner wall",
        "overhang wall", "thin wall",     "gap fill",
        "solid infill",  "sparse infill", "top skin",
        "bottom skin",   "bridge",        "internal bridge",
        "ironing",       "support",       "support interface",
        "skirt",         "brim",          "raft",
        "prime tower"};
    const auto index = static_cast<std::size_t>(role);
    return index < names.size() ? names[index] : names[0];
}

}  // namespace lyr::format
