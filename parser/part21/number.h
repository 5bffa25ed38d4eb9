// Decimal text to numbers, exactly.
//
// Contract
//  1. The text is a number token as skip_number() delimits it; these functions take all of it.
//  2. A real is the nearest double, ties to even. Beyond +-1.797...e308: out of range. Nearer to
//     zero than the smallest double: zero (or that double, as rounding has it), with the sign.
//  3. "1.", ".5", "+1", "1e5", "1E+5", "1D5" and "1d5" are numbers.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace lyr::part21 {

struct NumberToken {
    const char* after = nullptr;  // nullptr: no number stands here
    bool is_real = false;
};
NumberToken skip_number(const char* p, const char* end);

// Of a record's arguments from its opening bracket on, "('name',(1.,2.))": how many numbers are in the list. Empty where
// anything is written in another way, not necessarily a wrong one.
std::optional<std::size_t> plain_reals(const char* p, const char* end, std::span<double> out);

// Empty when out of range.
std::optional<double> real_of(std::string_view token);
std::optional<std::int64_t> integer_of(std::string_view token);
// Of the digits at p, as far as they go.
struct IdToken {
    const char* after;                // p if there are none
    std::optional<std::uint64_t> id;  // empty when out of range
};
IdToken read_id(const char* p, const char* end);

}  // namespace lyr::part21
