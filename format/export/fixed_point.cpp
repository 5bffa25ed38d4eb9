#include "format/export/fixed_point.h"

#include <charconv>
#include <cmath>

namespace lyr::format {

void append_fixed(std::string& out, std::int64_t count, int decimals) {
    char digits[24];
    if (count < 0) out += '-';
    const std::uint64_t size =
        count < 0 ? 0 - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
    const auto unit = static_cast<std::uint64_t>(power_of_ten(decimals));
    const auto whole = std::to_chars(digits, digits + sizeof digits, size / unit);
    out.append(digits, whole.ptr);
    std::uint64_t fraction = size % unit;
    if (fraction == 0) return;
    out += '.';
    for (std::uint64_t digit = unit / 10; fraction > 0; digit /= 10) {
        out += static_cast<char>('0' + fraction / digit);
        fraction %= digit;
    }
}

void append_rounded(std::string& out, double value, int decimals) {
    append_fixed(out, std::llround(value * static_cast<double>(power_of_ten(decimals))), decimals);
}

}  // namespace lyr::format
