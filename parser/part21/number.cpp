// std::from_chars, which rounds correctly and knows no locale, and what it does not do by itself.

#include "parser/part21/number.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "parser/part21/scan.h"

namespace lyr::part21 {
namespace {

bool is_exponent_letter(char c) {
    return c == 'E' || c == 'e' || c == 'D' || c == 'd';
}

// Whether a number that from_chars calls out of range is too large (and not too small). The power
// of ten of its first digit that is not zero decides; a range error is never near 10^0.
bool is_too_large(std::string_view token) {
    const std::size_t letter = token.find_first_of("EeDd");
    const std::string_view mantissa = token.substr(0, letter);
    const std::size_t first = mantissa.find_first_of("123456789");
    if (first == std::string_view::npos) return false;
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const auto leading = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
    if (letter == std::string_view::npos) return leading > 0;
    const std::string_view exponent = token.substr(letter + 1);
    const bool negative = exponent[0] == '-';
    const auto digits = exponent.substr(negative || exponent[0] == '+' ? 1 : 0);
    constexpr std::int64_t huge = std::int64_t{1} << 60;  // beyond any file's number of digits
    std::int64_t power = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (read.ec != std::errc{} || power > huge) power = huge;
    return (negative ? -power : power) + leading > 0;
}

}  // namespace

NumberToken skip_number(const char* p, const char* end) {
    if (p < end && (*p == '+' || *p == '-')) ++p;
    const char* first = p;
    p = skip_digits(p, end);
    std::ptrdiff_t digits = p - first;
    bool is_real = false;
    if (p < end && *p == '.') {
        const char* fraction = p + 1;
        p = skip_digits(fraction, end);
        digits += p - fraction;
        is_real = true;
    }
    if (digits == 0) return {};
    if (p < end && is_exponent_letter(*p)) {
        const char* exponent = p + 1;
        if (exponent < end && (*exponent == '+' || *exponent == '-')) ++exponent;
        p = skip_digits(exponent, end);
        if (p == exponent) return {};
        is_real = true;
    }
    return {p, is_real};
}

std::optional<double> real_of(std::string_view token) {
    if (token[0] == '+') token.remove_prefix(1);
    double value = 0;
    const auto read = std::from_chars(token.data(), token.data() + token.size(), value);
    if (read.ec == std::errc{} && read.ptr == token.data() + token.size()) return value;
    if (read.ec == std::errc{}) {  // stopped at Fortran's exponent letter
        std::string usual(token);
        std::replace_if(
            usual.begin(), usual.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
        return real_of(usual);
    }
    if (is_too_large(token)) return std::nullopt;
    return token[0] == '-' ? -0.0 : 0.0;
}

std::optional<std::int64_t> integer_of(std::string_view token) {
    if (token[0] == '+') token.remove_prefix(1);
    std::int64_t value = 0;
    const auto read = std::from_chars(token.data(), token.data() + token.size(), value);
    return read.ec == std::errc{} ? std::optional(value) : std::nullopt;
}

IdToken read_id(const char* p, const char* end) {
    constexpr std::ptrdiff_t always_fit = 19;
    const char* const first = p;
    std::uint64_t value = 0;
    for (; p < end && is_digit(*p); ++p) value = 10 * value + static_cast<std::uint64_t>(*p - '0');
    if (p - first <= always_fit) return {p, p > first ? std::optional(value) : std::nullopt};
    const auto read = std::from_chars(first, p, value);
    return {p, read.ec == std::errc{} ? std::optional(value) : std::nullopt};
}

std::optional<std::size_t> plain_reals(const char* p, const char* end, std::span<double> out) {
    // False, and p may be at the end, if something else comes.
    const auto take = [&](char expected) {
        p = skip_blank(p, end);
        return p != end && *p++ == expected;
    };
    if (!take('(')) return std::nullopt;
    p = skip_blank(p, end);
    p = p != end && *p == '\'' ? skip_string(p, end) : nullptr;
    if (!p || !take(',') || !take('(')) return std::nullopt;
    for (std::size_t count = 0; count < out.size();) {
        p = skip_blank(p, end);
        const char* const digits = p != end && *p == '-' ? p + 1 : p;
        // from_chars would take words as well: inf, nan(0).
        if (digits == end || !(is_digit(*digits) || *digits == '.')) return std::nullopt;
        const auto read = std::from_chars(p, end, out[count]);
        if (read.ec != std::errc{}) return std::nullopt;
        p = skip_blank(read.ptr, end);
        ++count;
        if (p != end && *p == ')') {
            ++p;
            return take(')') && take(';') ? std::optional(count) : std::nullopt;
        }
        if (!take(',')) return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace lyr::part21
