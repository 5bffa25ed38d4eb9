// Part 21 strings to UTF-8.
//
// Contract
//  1. The result is valid UTF-8 for any bytes.
//  2. 'a''b' is a'b; \\ is \; \X\E9 is U+00E9; \X2\03C0\X0\ and \X4\0001F600\X0\ are the characters
//     of these numbers, surrogate pairs in \X2\ joined; \S\i is the byte of i plus 128 in the
//     alphabet ISO 8859-1 or that of the last \PA\ .. \PI\ (8859-1 to -9) of this string; \N\ and
//     \F\ and line breaks leave nothing.
//  3. Bytes beyond ASCII stand for themselves where they form UTF-8, else for ISO 8859-1.
//  4. A backslash that starts none of these is a backslash. A \X\, \X2\ or \X4\ whose digits are
//     missing, too few or no character, or that \X0\ does not end, gives U+FFFD and `malformed`.

#pragma once

#include <string>
#include <string_view>

namespace lyr::part21 {

struct Text {
    std::string utf8;
    bool malformed = false;
};

// `content`: between the quotes, as in the file.
Text decode_text(std::string_view content);

void append_utf8(std::string& out, char32_t character);

// The character at byte 0xA0 + `index` of ISO 8859-`part`, part 1 to 9; 0 where the part has none.
char32_t latin_character(int part, int index);

}  // namespace lyr::part21
