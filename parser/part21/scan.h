// The lexical level of Part 21: what may stand between tokens, and where a token ends.
//
// Contract
//  1. Every function takes [p, end) and reads nothing outside it.
//  2. skip_blank() stops at the first byte that is neither whitespace, comment nor print directive
//     (\N\ \F\). A comment that is never closed is not skipped: it stops at its opening.
//  3. skip_string() takes p at the opening quote and returns the place after the closing one, or
//     nullptr when the string is not closed. A line break inside is allowed (old writers wrap at 80
//     columns); a line that starts like an instance (#5=) or with ENDSEC; tells that the quote was
//     forgotten, so that a string never swallows what follows it.

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lyr::part21 {

namespace detail {

enum : std::uint8_t { blank = 1, digit = 2, letter = 4, hex = 8, in_string = 16, in_record = 32 };

constexpr std::array<std::uint8_t, 256> make_classes() {
    std::array<std::uint8_t, 256> classes{};
    const auto mark = [&](std::string_view bytes, std::uint8_t bit) {
        for (const char c : bytes) {
            auto& entry = classes[static_cast<unsigned char>(c)];
            entry = static_cast<std::uint8_t>(entry | bit);
        }
    };
    mark(" \t\r\n\f\v", blank);
    mark("0123456789", digit);
    mark("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_", letter);
    mark("0123456789ABCDEFabcdef", hex);
    mark("'\\\r\n", in_string);
    mark("'/();=", in_record);
    return classes;
}
inline constexpr std::array<std::uint8_t, 256> classes = make_classes();

}  // namespace detail

inline bool has_class(char c, std::uint8_t bits) {
    return (detail::classes[static_cast<unsigned char>(c)] & bits) != 0;
}
inline bool is_blank(char c) {
    return has_class(c, detail::blank);
}
inline bool is_digit(char c) {
    return has_class(c, detail::digit);
}
inline bool is_letter(char c) {
    return has_class(c, detail::letter);
}

const char* skip_comments(const char* p, const char* end);  // the slow part of skip_blank()

inline const char* skip_blank(const char* p, const char* end) {
    while (p < end && is_blank(*p)) ++p;
    if (p < end && (*p == '/' || *p == '\\')) return skip_comments(p, end);
    return p;
}

const char* skip_string(const char* p, const char* end);

// A backslash at p inside a string: the end of what it introduces. \S\' holds a quote that does not
// close the string, and \\ a backslash that introduces nothing.
inline const char* skip_escape(const char* p, const char* end) {
    if (end - p >= 4 && p[1] == 'S' && p[2] == '\\') return p + 4;
    return end - p >= 2 && p[1] == '\\' ? p + 2 : p + 1;
}

inline const char* skip_digits(const char* p, const char* end) {
    while (p < end && is_digit(*p)) ++p;
    return p;
}
// Letters, digits and underscores.
inline const char* skip_word(const char* p, const char* end) {
    while (p < end && has_class(*p, detail::letter | detail::digit)) ++p;
    return p;
}
// A keyword, "!" in front for a user-defined one. Returns p when none stands there.
inline const char* skip_keyword(const char* p, const char* end) {
    const char* first = p < end && *p == '!' ? p + 1 : p;
    return first < end && is_letter(*first) ? skip_word(first, end) : p;
}

inline char to_upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
}
bool equals_upper(std::string_view text, std::string_view upper_case);
std::string upper(std::string_view text);

// What stands at p, for messages: "'CIRCLE'", "the end of the file", "the byte 0x00".
std::string found_at(const char* p, const char* end);
// The start of [p, end) on one line of printable characters.
std::string shortened(const char* p, const char* end);

}  // namespace lyr::part21
