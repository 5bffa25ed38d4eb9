// Coordinates are printed from whole nanometres: no rounding, no exponent.

#include "format/export/svg_text.h"

#include <charconv>
#include <cstdlib>

namespace lyr::format {
namespace {

// How many bytes the UTF-8 character at the front has; 0: there is none that XML may have.
std::size_t character_bytes(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t count = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < count) return 0;
    std::uint32_t code = first & (0x7fu >> count);
    for (std::size_t i = 1; i < count; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xc0) != 0x80) return 0;
        code = code << 6 | (next & 0x3fu);
    }
    const bool too_long = code < (count == 4 ? 0x10000u : count == 3 ? 0x800u : 0x80u);
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    const bool no_character = (code & 0xfffe) == 0xfffe || code > 0x10ffff;
    return too_long || surrogate || no_character ? 0 : count;
}

}  // namespace

void append_mm(std::string& out, std::int64_t quanta, Quantum quantum) {
    constexpr std::int64_t nm_per_mm = 1'000'000;
    const std::int64_t nm = quanta * quantum.nm;
    if (nm < 0) out += '-';
    out += std::to_string(std::abs(nm / nm_per_mm));
    std::int64_t fraction = std::abs(nm % nm_per_mm);
    if (fraction == 0) return;
    out += '.';
    for (std::int64_t digit = nm_per_mm / 10; fraction > 0; digit /= 10) {
        out += static_cast<char>('0' + fraction / digit);
        fraction %= digit;
    }
}

void append_number(std::string& out, double value) {
    constexpr int digits = 9;
    char text[40];
    const auto result =
        std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
    out.append(text, result.ptr);
}

std::string escaped_xml(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t bytes = character_bytes(text);
        const std::string_view character = text.substr(0, bytes);
        if (bytes == 0)
            out += '?';
        else if (character == "&")
            out += "&amp;";
        else if (character == "<")
            out += "&lt;";
        else if (character == ">")
            out += "&gt;";
        else if (character == "\"")
            out += "&quot;";
        else
            out += character;
        text.remove_prefix(bytes == 0 ? 1 : bytes);
    }
    return out;
}

}  // namespace lyr::format
