// UTF-8 is taken apart only as far as it takes to tell control characters and stray bytes.

#include "base/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace lyr {
namespace {

// Longer strings than this are cut in messages.
constexpr std::size_t longest_quote_bytes = 60;

struct Character {
    std::size_t bytes = 1;
    bool printable = false;
};

bool is_control(std::uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0);
}

// The character that the text, which is not empty, begins with; a byte that begins none is not printable.
Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return {1, !is_control(byte(0))};
    // By length: what the first byte must be under its mask, and the least code that needs the length.
    struct Form {
        unsigned mask, mark;
        std::uint32_t least;
    };
    constexpr std::array<Form, 3> forms{
        {{0xe0, 0xc0, 0x80}, {0xf0, 0xe0, 0x800}, {0xf8, 0xf0, 0x10000}}};
    for (std::size_t i = 0; i < forms.size(); ++i) {
        const std::size_t bytes = i + 2;
        if ((byte(0) & forms[i].mask) != forms[i].mark || text.size() < bytes) continue;
        std::uint32_t code = byte(0) & ~forms[i].mask;
        bool continued = true;
        for (std::size_t k = 1; k < bytes; ++k) {
            continued = continued && (byte(k) & 0xc0) == 0x80;
            code = code << 6 | (byte(k) & 0x3fu);
        }
        // Halves of UTF-16, and what is beyond the last character, are no UTF-8 either.
        const bool is_character = code < 0xd800 || (code > 0xdfff && code <= 0x10ffff);
        if (continued && code >= forms[i].least && is_character) return {bytes, !is_control(code)};
    }
    return {};
}

void append_escaped(std::string& out, unsigned char byte) {
    switch (byte) {
        case '\n':
            out += "\\n";
            return;
        case '\r':
            out += "\\r";
            return;
        case '\t':
            out += "\\t";
            return;
    }
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", byte);
    out += code;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const Character character = first_character(text);
        const std::string_view bytes = text.substr(0, character.bytes);
        if (character.printable) {
            out += bytes;
        } else {
            for (const char byte : bytes) append_escaped(out, static_cast<unsigned char>(byte));
        }
        text.remove_prefix(character.bytes);
    }
    return out;
}

std::string in_quotes(std::string_view text) {
    std::size_t kept = 0;
    while (kept < text.size()) {
        const std::size_t next = kept + first_character(text.substr(kept)).bytes;
        if (next > longest_quote_bytes) break;
        kept = next;
    }
    return '"' + escaped(text.substr(0, kept)) + (kept < text.size() ? "...\"" : "\"");
}

std::string in_json(std::string_view text) {
    constexpr unsigned char first_printable = 0x20;
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') json += '\\';
        if (static_cast<unsigned char>(c) < first_printable)
            json += formatted("\\u%04x", static_cast<unsigned>(c));
        else
            json += c;
    }
    return json + '"';
}

std::string in_json(double value, int decimals) {
    return std::isfinite(value) ? formatted("%.*f", decimals, value) : "null";
}

std::string counted(std::uint64_t count, std::string_view noun) {
    return std::to_string(count) + ' ' + std::string(noun) + (count == 1 ? "" : "s");
}

std::optional<double> finite_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::string clock_text(double time_s) {
    const auto whole_s = static_cast<long long>(time_s);
    return formatted("%lld:%02lld:%02lld", whole_s / 3600, whole_s / 60 % 60, whole_s % 60);
}

std::string shortest(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return error == std::errc() ? std::string(text, end) : std::string();
}

std::string formatted(const char* format, ...) {
    std::array<char, 512> line{};
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(line.data(), line.size(), format, values);
    va_end(values);
    return line.data();
}

}  // namespace lyr
