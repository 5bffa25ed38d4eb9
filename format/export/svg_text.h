// Numbers and names as SVG has them.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "format/operation.h"

namespace lyr::format {

// Quanta as mm, with all their digits and no more: 12345 of 1000 nm is "12.345".
void append_mm(std::string& out, std::int64_t quanta, Quantum quantum);

// At most nine significant digits: a nanometre on a metre.
void append_number(std::string& out, double value);

// As text or attribute; what XML cannot have becomes '?'.
std::string escaped_xml(std::string_view text);

}  // namespace lyr::format
