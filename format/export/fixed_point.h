// Decimal numbers as whole counts of their last digit, as G-code has them: what is written adds up without rounding.

#pragma once

#include <cstdint>
#include <string>

namespace lyr::format {

constexpr std::int64_t power_of_ten(int exponent) {
    std::int64_t power = 1;
    for (; exponent > 0; --exponent) power *= 10;
    return power;
}

// 12300 with 4 decimals is "1.23", -5 is "-0.0005".
void append_fixed(std::string& out, std::int64_t count, int decimals);

// Rounded to so many decimals.
void append_rounded(std::string& out, double value, int decimals);

}  // namespace lyr::format
