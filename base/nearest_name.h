// "Did you mean": the known name that a mistyped one most likely stands for.
//
// Contract
//  1. The result is one of `known`, the first of those with the fewest single-letter edits, or empty
//     if even that one differs by more than a third of the letters (at least 2 edits are allowed).
//  2. Swapping two neighbouring letters, the commonest slip, is one edit.

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace lyr {

std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace lyr
