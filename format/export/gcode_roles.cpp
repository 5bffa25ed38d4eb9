#include "format/export/gcode_roles.h"

#include <algorithm>
#include <array>
#include <utility>

namespace lyr::format {
namespace {

constexpr std::array<std::string_view, role_count> written{"Custom",
                                                           "External perimeter",
                                                           "Perimeter",
                                                           "Overhang perimeter",
                                                           "External perimeter",
                                                           "Gap fill",
                                                           "Solid infill",
                                                           "Internal infill",
                                                           "Top solid infill",
                                                           "Solid infill",
                                                           "Bridge infill",
                                                           "Bridge infill",
                                                           "Ironing",
                                                           "Support material",
                                                           "Support material interface",
                                                           "Skirt/Brim",
                                                           "Skirt/Brim",
                                                           "Support material",
                                                           "Wipe tower"};

// Besides those that are written: OrcaSlicer's, then Cura's.
constexpr std::pair<std::string_view, Role> read[] = {
    {"Outer wall", Role::outer_wall},
    {"Inner wall", Role::inner_wall},
    {"Overhang wall", Role::overhang_wall},
    {"Thin wall", Role::thin_wall},
    {"Gap infill", Role::gap_fill},
    {"Internal solid infill", Role::solid_infill},
    {"Sparse infill", Role::sparse_infill},
    {"Top surface", Role::top_skin},
    {"Bottom surface", Role::bottom_skin},
    {"Bridge", Role::bridge},
    {"Internal Bridge", Role::internal_bridge},
    {"Internal bridge infill", Role::internal_bridge},
    {"Support", Role::support},
    {"Support interface", Role::support_interface},
    {"Support transition", Role::support_interface},
    {"Skirt", Role::skirt},
    {"Brim", Role::brim},
    {"Prime tower", Role::prime_tower},
    {"WALL-OUTER", Role::outer_wall},
    {"WALL-INNER", Role::inner_wall},
    {"FILL", Role::sparse_infill},
    {"SKIN", Role::solid_infill},
    {"SUPPORT", Role::support},
    {"SUPPORT-INTERFACE", Role::support_interface},
    {"SKIRT", Role::skirt},
    {"PRIME-TOWER", Role::prime_tower},
};

}  // namespace

std::string_view gcode_name_of(Role role) {
    const auto index = static_cast<std::size_t>(role);
    return written[index < written.size() ? index : 0];
}

Role role_of_gcode(std::string_view name) {
    const auto own = std::find(written.begin(), written.end(), name);
    if (own != written.end()) return static_cast<Role>(own - written.begin());
    const auto* const foreign = std::find_if(
        std::begin(read), std::end(read), [&](const auto& entry) { return entry.first == name; });
    return foreign == std::end(read) ? Role::other : foreign->second;
}

Role role_named(std::string_view name) {
    for (std::size_t i = 0; i < role_count; ++i)
        if (name_of(static_cast<Role>(i)) == name) return static_cast<Role>(i);
    return Role::other;
}

}  // namespace lyr::format
