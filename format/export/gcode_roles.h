// The names that comments of G-code give to roles.

#pragma once

#include <string_view>

#include "format/operation.h"

namespace lyr::format {

// That of PrusaSlicer which comes next to the role: what viewers show.
std::string_view gcode_name_of(Role role);

// What a comment of PrusaSlicer, OrcaSlicer or Cura names; `other` for what is not known.
Role role_of_gcode(std::string_view name);

// By this name of operation.h.
Role role_named(std::string_view name);

}  // namespace lyr::format
