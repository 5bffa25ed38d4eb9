// What the web page must show before it may control anything.
//
// Contract
//  1. random_token() has 128 bits from the kernel.
//  2. token_in() takes the token from a file that its owner alone may read, and makes the file where there is none. A
//     file that others may read, or a token of less than least_token_letters, is an error (status input).
//  3. is_token() takes as long for a token that is wrong in its first letter as for one that is wrong in its last.

#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"

namespace lyr::control {

inline constexpr std::size_t least_token_letters = 16;

Result<std::string> random_token();
Result<std::string> token_in(const std::string& path);

bool is_token(std::string_view offered, std::string_view token);

}  // namespace lyr::control
