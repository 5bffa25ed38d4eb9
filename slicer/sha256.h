// SHA-256 of a model's file, which a print states: whether a print was made from just this model can then be told.

#pragma once

#include <string>
#include <string_view>

namespace lyr::slicer {

// 64 hexadecimal digits, as sha256sum prints them.
std::string sha256_of(std::string_view bytes);

}  // namespace lyr::slicer
