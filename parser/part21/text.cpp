// One pass over the bytes of a string; see text.h for what each escape means.

#include "parser/part21/text.h"

#include <optional>

#include "parser/part21/scan.h"

namespace lyr::part21 {
namespace {

constexpr char32_t replacement = 0xFFFD;

bool is_surrogate(char32_t c) {
    return c >= 0xD800 && c <= 0xDFFF;
}
bool is_character(char32_t c) {
    return c <= 0x10FFFF && !is_surrogate(c);
}

// The length of the UTF-8 sequence at the start of `bytes` (2 to 4), or 0 if none stands there.
std::size_t utf8_length(std::string_view bytes) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    const unsigned char lead = at(0);
    const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                               : lead >= 0xE0 && lead <= 0xEF ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    if (length == 0 || bytes.size() < length) return 0;
    char32_t character = lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((at(i) & 0xC0u) != 0x80) return 0;
        character = character << 6 | (at(i) & 0x3Fu);
    }
    const bool overlong =
        (length == 3 && character < 0x800) || (length == 4 && character < 0x10000);
    return overlong || !is_character(character) ? 0 : length;
}

std::optional<char32_t> hex_value(std::string_view digits) {
    char32_t value = 0;
    for (const char c : digits) {
        if (!has_class(c, detail::hex)) return std::nullopt;
        value = value << 4 | static_cast<char32_t>(is_digit(c) ? c - '0' : to_upper(c) - 'A' + 10);
    }
    return value;
}

class Decoder {
public:
    explicit Decoder(std::string_view content) : rest_(content) {}

    Text decode() {
        text_.utf8.reserve(rest_.size());
        while (!rest_.empty()) {
            const char c = rest_[0];
            if (c == '\\') {
                escape();
            } else if (c == '\'') {
                plain(rest_.starts_with("''") ? 2 : 1, '\'');
            } else if (c == '\n' || c == '\r') {
                rest_.remove_prefix(1);
            } else if (static_cast<unsigned char>(c) >= 0x80) {
                beyond_ascii();
            } else {
                plain(1, c);
            }
        }
        return std::move(text_);
    }

private:
    void plain(std::size_t count, char c) {
        text_.utf8 += c;
        rest_.remove_prefix(count);
    }

    void beyond_ascii() {
        const std::size_t length = utf8_length(rest_);
        if (length == 0) {
            append_utf8(text_.utf8, static_cast<unsigned char>(rest_[0]));
        } else {
            text_.utf8 += rest_.substr(0, length);
        }
        rest_.remove_prefix(length == 0 ? 1 : length);
    }

    void malformed() {
        append_utf8(text_.utf8, replacement);
        text_.malformed = true;
    }

    void escape() {
        const char next = rest_.size() > 1 ? rest_[1] : '\0';
        const bool short_form = rest_.size() > 2 && rest_[2] == '\\';
        if (next == '\\') {
            plain(2, '\\');
        } else if (short_form && (next == 'N' || next == 'F')) {
            rest_.remove_prefix(3);
        } else if (short_form && next == 'S' && rest_.size() > 3) {
            shifted();
        } else if (next == 'P' && rest_.size() > 3 && rest_[2] >= 'A' && rest_[2] <= 'I' &&
                   rest_[3] == '\\') {
            part_ = rest_[2] - 'A' + 1;
            rest_.remove_prefix(4);
        } else if (short_form && next == 'X') {
            single_byte();
        } else if (rest_.starts_with("\\X2\\")) {
            wide(4);
        } else if (rest_.starts_with("\\X4\\")) {
            wide(8);
        } else {
            plain(1, '\\');
        }
    }

    void shifted() {
        const int index = static_cast<unsigned char>(rest_[3]) - 0x20;
        const char32_t character = index >= 0 && index < 96 ? latin_character(part_, index) : 0;
        if (character) {
            append_utf8(text_.utf8, character);
        } else {
            malformed();
        }
        rest_.remove_prefix(4);
    }

    void single_byte() {
        rest_.remove_prefix(3);
        const auto value = rest_.size() < 2 ? std::nullopt : hex_value(rest_.substr(0, 2));
        if (!value) return malformed();
        append_utf8(text_.utf8, *value);
        rest_.remove_prefix(2);
    }

    void wide(std::size_t digits) {
        rest_.remove_prefix(4);
        constexpr std::string_view closing = "\\X0\\";
        char32_t high = 0;  // a high surrogate that waits for its low one
        while (!rest_.starts_with(closing)) {
            const auto value =
                rest_.size() < digits ? std::nullopt : hex_value(rest_.substr(0, digits));
            if (!value) return malformed();
            rest_.remove_prefix(digits);
            if (high && *value >= 0xDC00 && *value <= 0xDFFF) {
                append_utf8(text_.utf8, 0x10000 + ((high - 0xD800) << 10) + (*value - 0xDC00));
                high = 0;
                continue;
            }
            if (high) malformed();
            high = *value >= 0xD800 && *value <= 0xDBFF ? *value : 0;
            if (high) continue;
            if (is_character(*value)) {
                append_utf8(text_.utf8, *value);
            } else {
                malformed();
            }
        }
        if (high) malformed();
        rest_.remove_prefix(closing.size());
    }

    std::string_view rest_;
    int part_ = 1;
    Text text_;
};

}  // namespace

void append_utf8(std::string& out, char32_t character) {
    const auto push = [&](char32_t byte) { out += static_cast<char>(byte); };
    if (character < 0x80) {
        push(character);
    } else if (character < 0x800) {
        push(0xC0 | character >> 6);
        push(0x80 | (character & 0x3F));
    } else if (character < 0x10000) {
        push(0xE0 | character >> 12);
        push(0x80 | (character >> 6 & 0x3F));
        push(0x80 | (character & 0x3F));
    } else {
        push(0xF0 | character >> 18);
        push(0x80 | (character >> 12 & 0x3F));
        push(0x80 | (character >> 6 & 0x3F));
        push(0x80 | (character & 0x3F));
    }
}

Text decode_text(std::string_view content) {
    return Decoder(content).decode();
}

}  // namespace lyr::part21
